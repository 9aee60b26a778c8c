// The keyboard: one table for the actions of keys and for the help at `?`.
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

// Whether the focused element handles the key itself. A button focused by Tab handles space, the only way to press
// it without a mouse; one focused by a click does not, so that space still plays and pauses.
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
