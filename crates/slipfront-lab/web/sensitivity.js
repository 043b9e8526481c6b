// @ts-check
// How much the static friction peak changes with a quantity: told below its slider, by two runs of the case
// that are begun when the slider has been pointed at for a moment, or has the focus.
import { send } from './connection.js';
import { find } from './element.js';
import { announce } from './notices.js';
import { fixed, number, prefix } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';

/** @import { SensitivityReply } from '../types/protocol' */

/** Who only passes a slider asks nothing, and a case that was just changed may be changed again. */
const QUIET_MS = 400;
/** Quantities of which two values that are close to each other mean nothing. */
const WITHOUT = ['seed'];

/** The slider that is pointed at or has the focus, by the name of its quantity. @type {string|null} */
let wanted = null;
/** The quantity that was asked for and is not yet answered. @type {string|null} */
let asked = null;
/** Quantities that were asked for since the case was last changed. */
const known = new Set();
let isPressed = false;
let timer = 0;

/** @param {string} id */
const place = (id) => find(`control-${id}-sensitivity`);

/** @param {string} id @param {string} text */
function write(id, text) {
  place(id).textContent = text;
  if (text !== '') place(id).hidden = false;
}

/** Takes lines away that say nothing, unless the pointer is among the sliders, which would move under it. */
function collapse() {
  if (find('controls').matches(':hover')) return;
  for (const line of find('controls').querySelectorAll('.sensitivity')) /** @type {HTMLElement} */ (line).hidden = line.textContent === '';
}

function forget() {
  known.clear();
  asked = null;
  for (const line of find('controls').querySelectorAll('.sensitivity')) line.textContent = '';
  collapse();
  later();
}

/** Whether something of the case is being changed. */
const isEdited = () => isPressed || find('controls').querySelector('[data-typing]') !== null;

function ask() {
  if (wanted === null || asked !== null || known.has(wanted) || WITHOUT.includes(wanted) || isEdited() || !state.case?.values[wanted]) return;
  asked = wanted;
  known.add(wanted);
  write(wanted, say('sensitivity_asked'));
  send({ do: 'sensitivity', control: wanted });
}

/** Asks after a quiet moment. */
function later() {
  clearTimeout(timer);
  timer = window.setTimeout(ask, QUIET_MS);
}

/** The two values as the slider has them, with the unit behind. @param {SensitivityReply} reply */
function range({ control, values }) {
  const { key, si_key: siKey, unit } = state.hello?.controls.find(({ id }) => id === control) ?? { key: '', si_key: null, unit: '' };
  if (unit === '' || key !== siKey) return say('sensitivity_range', { from: number(values[0]), to: number(values[1]), unit: siKey === null ? unit : '' }).trim();
  const [factor, letter] = prefix(Math.max(...values.map(Math.abs)));
  return say('sensitivity_range', { from: number(values[0] / factor), to: number(values[1] / factor), unit: `${letter}${unit}` });
}

/** @param {SensitivityReply} reply */
function take(reply) {
  const { control, percent } = reply;
  // What was asked of a case before tells nothing of this one.
  if (control !== asked) return;
  asked = null;
  const change = `${(percent ?? 0) > 0 ? '+' : ''}${fixed(percent, Math.abs(percent ?? 1) < 0.1 ? 2 : 1)} %`;
  const text = say(percent === null ? 'sensitivity_none' : 'sensitivity', { name: say(`control_${control}`), range: range(reply), change });
  write(control, text);
  if (document.activeElement?.id === `control-${control}-slider`) announce(text);
  ask();
}

/** The quantity of the slider in which an event happens. @param {Event} event */
const quantityOf = (event) => /** @type {HTMLElement} */ (event.target).closest('.control')?.getAttribute('data-control') ?? null;

/** @param {string|null} id */
function want(id) {
  if (id === null || id === wanted) return;
  wanted = id;
  later();
}

/** Begins to listen. */
export function startSensitivity() {
  const controls = find('controls');
  controls.addEventListener('pointerover', (event) => want(quantityOf(event)));
  controls.addEventListener('pointerleave', () => {
    const focused = document.activeElement?.closest('.control')?.getAttribute('data-control') ?? null;
    wanted = focused;
    collapse();
  });
  controls.addEventListener('focusin', (event) => {
    if (/** @type {HTMLElement} */ (event.target).matches('[type=range]')) want(quantityOf(event));
  });
  controls.addEventListener('focusout', () => {
    if (!controls.matches(':hover')) wanted = null;
    collapse();
  });
  // Sliders are dragged and textures painted with a button pressed.
  document.addEventListener('pointerdown', () => (isPressed = true), { capture: true });
  for (const end of ['pointerup', 'pointercancel']) {
    document.addEventListener(end, () => {
      isPressed = false;
      later();
    }, { capture: true });
  }
  on('case', forget);
  on('connected', forget);
  on('sensitivity', take);
  on('refused', ({ of, sentence }) => {
    if (of !== 'sensitivity' || asked === null) return;
    write(asked, sentence.split('\n')[0]);
    asked = null;
  });
}
