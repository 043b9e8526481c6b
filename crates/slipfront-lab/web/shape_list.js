// @ts-check
// The textures as a list; the selected one has its numbers.
import { change } from './edit.js';
import { find, make } from './element.js';
import { fixed, length, metres, typed } from './quantity.js';
import { center, kind, sliderOf } from './shapes.js';
import { on, presentCase, put, state } from './store.js';
import { say } from './text.js';
import { removeSelected } from './tools.js';

/** @import { Texture } from '../types/protocol' */
/** @typedef {{key: string, value: number, set: (value: number) => Partial<Texture>}} Field `key` names it in en.json; `set` gives the keys that change */

const MICRO = 1e6;

/** Whether the case has changed while a number was typed. */
let waiting = false;

/** @param {Texture} table @param {'coverage'|'rotate'|'s'|'w'|'threshold'|'bearing_percent'} key @returns {Field} */
const plain = (table, key, standard = 0) => ({ key, value: table[key] ?? standard, set: (value) => ({ [key]: value }) });

/** A length in micrometres. @param {Texture} table @param {'lambda'|'width'|'offset'} key @returns {Field} */
const micrometres = (table, key) => ({ key, value: (metres(table[key]) ?? 0) * MICRO, set: (value) => ({ [key]: length(value / MICRO) }) });

/** @param {Texture} table @returns {Field[]} */
const sizes = (table) => [
  ...('coverage' in table ? [plain(table, 'coverage')] : []),
  ...('lambda' in table ? [micrometres(table, 'lambda')] : []),
  ...('width' in table ? [micrometres(table, 'width')] : []),
];

/** @param {Texture} table @returns {Field[]} */
function centers(table) {
  const at = center(table, sliderOf(presentCase()));
  return ['x', 'y'].map((key, axis) => ({
    key,
    value: at[axis] * MICRO,
    set: (value) => ({ center: at.map((old, k) => length(k === axis ? value / MICRO : old)) }),
  }));
}

/** @param {Texture} table @returns {Field[]} */
function copies(table) {
  const { array } = table;
  if (!Array.isArray(array)) return [];
  return ['columns', 'rows'].map((key, axis) => ({
    key,
    value: array[axis],
    set: (value) => ({ array: array.map((old, k) => (k === axis ? value : old)) }),
  }));
}

/** The numbers of a texture. @param {Texture} table @returns {Field[]} */
function fields(table) {
  if (table.shape === 'cavity') return [...sizes(table), ...centers(table), plain(table, 'rotate'), plain(table, 's', 1), plain(table, 'w'), ...copies(table)];
  if (table.shape === 'groove') return [...sizes(table), micrometres(table, 'offset'), ...copies(table)];
  if (table.shape === 'mask') return [plain(table, 'threshold', 0.5)];
  if (table.shape === 'height_map' && 'bearing_percent' in table) return [plain(table, 'bearing_percent')];
  return copies(table);
}

/** @param {number} index @param {Field} field */
function row(index, { key, value, set }) {
  const id = `shape-${key}`;
  const input = make('input', { id, type: 'text', inputMode: 'decimal', size: 7, value: String(Number(value.toPrecision(6))), autocomplete: 'off' });
  input.addEventListener('input', () => (input.dataset.typing = 'yes'));
  input.addEventListener('blur', () => {
    delete input.dataset.typing;
    // Once the focus has arrived where it goes.
    if (waiting) setTimeout(update);
  });
  input.addEventListener('change', () => {
    delete input.dataset.typing;
    const given = typed(input.value);
    if (given === null) return show();
    change({ texture: presentCase().texture.map((old, k) => (k === index ? { ...old, ...set(given) } : old)) });
  });
  return make('div', {}, [make('label', { for: id, textContent: say(`shape_${key}`) }), input]);
}

/** @param {Texture} table @param {number} index */
function item(table, index) {
  const selected = index === state.selected;
  const share = 'coverage' in table ? `${fixed(table.coverage, 1)} %` : '';
  const button = make('button', { type: 'button', 'aria-expanded': String(selected), textContent: say('shape_item', { number: index + 1, kind: say(`kind_${kind(table)}`), share }) });
  button.addEventListener('click', () => put('selected', selected ? null : index));
  if (!selected) return make('li', {}, [button]);
  const remove = make('button', { type: 'button', id: 'shape-remove', textContent: say('shape_remove') });
  remove.addEventListener('click', removeSelected);
  return make('li', {}, [button, make('div', { className: 'shape-fields' }, fields(table).map((field) => row(index, field))), remove]);
}

function show() {
  const list = find('shapes');
  const texture = state.case?.texture ?? [];
  const focused = list.contains(document.activeElement) ? document.activeElement : null;
  const [id, place] = [focused?.id, [...list.querySelectorAll('button')].findIndex((button) => button === focused)];
  list.replaceChildren(...texture.map(item));
  find('no-shapes').hidden = texture.length > 0;
  find('too-coarse').textContent = state.case?.too_coarse ?? '';
  // The list is made anew, but the reader stays where he was, and what he types replaces the number as after
  // Tab.
  if (id) {
    const again = document.getElementById(id);
    again?.focus();
    if (again instanceof HTMLInputElement) again.select();
  } else if (focused) list.querySelectorAll('button')[place]?.focus();
}

/** A number that is being typed is not taken away. */
function update() {
  waiting = find('shapes').querySelector('[data-typing]') !== null;
  if (!waiting) show();
}

/** Begins to listen. */
export function startShapeList() {
  on('case', update);
  on('selected', show);
}
