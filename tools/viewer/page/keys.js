// The keyboard: one table for what keys do and for what `?` shows.
import {$} from './panels.js';

function showKeys(table) {
  $('key_table').replaceChildren(...table.map(([keys, text]) => {
    const row = document.createElement('tr');
    const left = document.createElement('td'), right = document.createElement('td');
    left.append(...keys.flatMap(key => {
      const shown = document.createElement('kbd');
      shown.textContent = key === ' ' ? 'space' : key;
      return [shown, ' '];
    }));
    right.textContent = text;
    row.append(left, right);
    return row;
  }));
  $('keys').showModal();
}

// table: [[keys], what they do, function of the key].
export function connectKeys(table) {
  const whole = [...table, [['?'], 'these keys', () => showKeys(whole)]];
  $('help').onclick = () => showKeys(whole);
  document.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey || /INPUT|SELECT/.test(event.target.tagName)) return;
    const entry = whole.find(([keys]) => keys.includes(event.key));
    if (!entry || $('keys').open) return;
    event.preventDefault();
    entry[2](event.key);
  });
}
