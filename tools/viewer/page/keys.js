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

// Whether what has the focus wants the key itself. Space is of a button that Tab led to: without a mouse there is
// no other way to press it. Of one that was clicked it is not, or nobody could play after a click.
function isOfFocused(event, byTab) {
  const {tagName, type} = event.target;
  if (tagName === 'SELECT' || (tagName === 'INPUT' && type !== 'checkbox')) return true;
  return event.key === ' ' && (tagName === 'INPUT' || (byTab && /BUTTON|SUMMARY/.test(tagName)));
}

// table: [[keys], what they do, function of the key].
export function connectKeys(table) {
  const whole = [...table, [['?'], 'these keys', () => showKeys(whole)]];
  $('help').onclick = () => showKeys(whole);
  let byTab = false;
  document.addEventListener('pointerdown', () => { byTab = false; });
  document.addEventListener('keydown', event => {
    byTab ||= event.key === 'Tab';
    if (event.ctrlKey || event.metaKey || event.altKey || isOfFocused(event, byTab)) return;
    const entry = whole.find(([keys]) => keys.includes(event.key));
    if (!entry || $('keys').open) return;
    event.preventDefault();
    entry[2](event.key);
  });
}
