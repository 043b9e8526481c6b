// @ts-check
// Sliders and number fields of the quantities that the server offers, each in both forms: dimensionless and
// with its unit.
import { change, gradual } from './edit.js';
import { find, make, rewrite } from './element.js';
import { notice } from './notices.js';
import { number, quantity, typed } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';

/** Places of a slider. */
const PLACES = 1000;

/** @import { Control, ControlValue } from '../types/protocol' */

/** Whether the control has no dimensionless key: its slider then goes over the value with a unit. @param {Control} control */
const dimensional = (control) => control.key === control.si_key;

/** @param {Control} control @param {number} place */
function valueAt({ min, max, logarithmic, whole }, place) {
  const share = place / PLACES;
  const value = logarithmic ? min * (max / min) ** share : min + (max - min) * share;
  return whole ? Math.round(value) : Number(value.toPrecision(3));
}

/** @param {Control} control @param {number} value */
function placeOf({ min, max, logarithmic }, value) {
  const within = Math.min(Math.max(value, min), max);
  return PLACES * (logarithmic ? Math.log(within / min) / Math.log(max / min) : (within - min) / (max - min));
}

/** What is set for a value: a number, or a text with its unit. @param {Control} control @param {number} value */
const keysFor = (control, value) => ({ [control.key]: dimensional(control) ? `${value} ${control.unit}` : value });

/** The two forms of a value: that of the number field, and the other one beside it. @param {Control} control @param {ControlValue} value */
function forms(control, { star, si }) {
  if (dimensional(control)) return { main: si, other: say(`other_${control.id}`, { value: number(star) }) };
  return { main: star, other: si === null ? control.unit : `= ${quantity(si, control.unit)}` };
}

/** @param {Control} control */
function row(control) {
  const id = `control-${control.id}`;
  const name = say(`control_${control.id}`);
  const slider = make('input', { type: 'range', id: `${id}-slider`, min: '0', max: String(PLACES), step: '1', 'aria-label': name, 'aria-describedby': `effect ${id}-sensitivity` });
  const field = make('input', { type: 'text', inputMode: 'decimal', id, 'aria-describedby': 'effect', autocomplete: 'off', size: 7 });
  const other = make('span', { className: 'other', id: `${id}-other` });
  const label = make('label', { for: id, textContent: name });
  label.title = say(`control_${control.id}_hint`);
  const unit = dimensional(control) ? [make('span', { textContent: control.unit })] : [];
  const sensitivity = make('p', { className: 'sensitivity', id: `${id}-sensitivity`, hidden: true });
  const element = make('div', { className: 'control' }, [make('div', { className: 'control-line' }, [label, field, ...unit, other]), slider, sensitivity]);
  element.dataset.control = control.id;
  return { control, element, slider, field, other };
}

/** Whether a number with a unit was typed, which the case understands. @param {string} text */
const hasUnit = (text) => /^\s*[-+]?[\d.]+(e[-+]?\d+)?\s*[a-z\u00b5\u03bc%\u00b0][\w/^\u00b5\u03bc]*\s*$/i.test(text);

/** @param {ReturnType<typeof row>} made */
function listen({ control, slider, field }) {
  /** @type {ReturnType<typeof gradual>|null} */
  let gesture = null;
  slider.addEventListener('input', () => {
    gesture ??= gradual();
    const value = valueAt(control, slider.valueAsNumber);
    field.value = String(value);
    gesture.change(keysFor(control, value));
  });
  slider.addEventListener('change', () => {
    gesture?.end();
    gesture = null;
  });
  field.addEventListener('input', () => (field.dataset.typing = 'yes'));
  field.addEventListener('change', () => {
    delete field.dataset.typing;
    const value = typed(field.value);
    if (value !== null) change(keysFor(control, value));
    else if (control.si_key !== null && hasUnit(field.value)) change({ [control.si_key]: field.value.trim() });
    else {
      const { unit } = control;
      const example = control.si_key === null ? '' : say('not_a_number_example', { unit });
      notice(say('not_a_number', { name: say(`control_${control.id}`), text: field.value, example }), { topic: 'refused' });
      show();
    }
  });
}

/** @type {Array<ReturnType<typeof row>>} */
let rows = [];

function show() {
  for (const { control, slider, field, other } of rows) {
    const value = state.case?.values[control.id];
    if (!value) continue;
    const { main, other: text } = forms(control, value);
    // What is being typed stays.
    if (!field.dataset.typing && main !== null) rewrite(field, String(Number(main.toPrecision(6))));
    if (!slider.matches(':active') && main !== null) slider.value = String(placeOf(control, main));
    slider.setAttribute('aria-valuetext', `${main === null ? '' : number(main)} ${text}`);
    other.textContent = text;
  }
}

/** Makes the sliders when the server has said which there are. Where the page has one column they are folded at first. */
export function startControls() {
  find('controls-fold').open = !matchMedia('(max-width: 899px)').matches;
  on('hello', ({ controls }) => {
    rows = controls.map(row);
    find('controls').replaceChildren(...rows.map((made) => made.element));
    rows.forEach(listen);
  });
  on('case', show);
}
