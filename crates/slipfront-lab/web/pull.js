// @ts-check
// How the slider is pulled: an arrow tells whither, and a drawing from the side shows the far end of the
// spring, which moves steadily, the force by which the spring is stretched, and the slider, which waits until
// friction gives way.
import { find } from './element.js';
import { fixed, number, ticks } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';

/** @import { CaseReply, CurveReply, NumbersReply } from '../types/protocol' */

/** Places in the drawing: the end of the slider, the far end of the spring without force, and that under the largest force of the scale. */
const SLIDER_END = 64;
const REST = 110;
const LAST = 270;
/** Height of the spring in the drawing, the half width of its coils, how many it has, and the distance of the marks on the ground. */
const HEIGHT = 33;
const COIL = 7;
const COILS = 10;
const MARKS = 20;
/** Height of the scale, and its smallest range in units of mu*. */
const SCALE = 12;
const LEAST = 1.2;

/** By how much the far end has moved, in units of mu*, the time up to which it is known, and the largest mu* up to then. */
let pulled = 0;
let time = 0;
let largest = 0;
/** The largest mu* of the scale. */
let range = 0;

/** The place of the far end of the spring under a force. @param {number} mu */
const placeOf = (mu) => REST + ((LAST - REST) * mu) / range;

/** The line of a spring between two places. @param {number} from @param {number} to */
function spring(from, to) {
  const coils = Array.from({ length: COILS }, (_, k) => {
    const x = from + ((to - from) * (k + 0.5)) / COILS;
    return `L${x.toFixed(1)} ${HEIGHT + (k % 2 === 0 ? -COIL : COIL)}`;
  });
  return `M${from} ${HEIGHT} ${coils.join(' ')} L${to.toFixed(1)} ${HEIGHT}`;
}

/** @param {string} name @param {Record<string, string>} attributes @param {string} [text] */
function drawn(name, attributes, text = '') {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.textContent = text;
  return element;
}

function drawScale() {
  const marks = ticks(0, range, 3);
  const line = `M${placeOf(0)} ${SCALE} H${placeOf(range)} ${marks.map((mu) => `M${placeOf(mu).toFixed(1)} ${SCALE} v4`).join(' ')}`;
  const names = marks.map((mu) => drawn('text', { x: placeOf(mu).toFixed(1), y: String(SCALE - 3) }, number(mu)));
  find('pull-scale').replaceChildren(drawn('path', { d: line }), ...names);
}

/** @param {number} mu */
function draw(mu) {
  if (largest > range || range === 0) {
    range = Math.max(LEAST, 1.3 * largest);
    drawScale();
  }
  const end = placeOf(mu);
  find('pull-spring').setAttribute('d', spring(SLIDER_END, end));
  find('pull-end').setAttribute('transform', `translate(${end.toFixed(1)} ${HEIGHT})`);
  find('pull-largest').setAttribute('transform', `translate(${placeOf(largest).toFixed(1)} ${HEIGHT})`);
  // The slider stays where it is in the drawing: the ground passes below it.
  const moved = placeOf(pulled) - placeOf(mu);
  find('pull-ground').setAttribute('transform', `translate(${(-(moved % MARKS)).toFixed(1)} 0)`);
}

/** @param {CurveReply} curve */
function take({ from_rest: fromRest, t, mu }) {
  if (fromRest) {
    [pulled, time, largest, range] = [0, 0, 0, 0];
    draw(0);
  }
  if (t.length === 0) return;
  const last = t.length - 1;
  pulled += (state.case?.loading_rate ?? 0) * (t[last] - time);
  time = t[last];
  largest = mu.reduce((most, value) => Math.max(most, value), largest);
  draw(mu[last]);
}

/** Says the force and whether a block in contact has slipped, which is the instant B. @param {NumbersReply} numbers */
function showState({ instants, mu_star: mu }) {
  find('pull-state').textContent = say('B' in instants ? 'pull_slips' : 'pull_loads', { mu: fixed(mu), most: fixed(largest) });
}

/** @param {CaseReply} shown */
function showCase({ drive_degrees: degrees }) {
  // A drive that turns the slider has no direction.
  find('drive').hidden = degrees === null;
  find('pull').hidden = degrees === null;
  // Angles go from x towards y, which points up on the page.
  const arrow = /** @type {SVGElement} */ (find('drive').firstElementChild);
  arrow.style.transform = `rotate(${-(degrees ?? 0)}deg)`;
}

/** Begins to listen. */
export function startPull() {
  on('case', showCase);
  on('curve', take);
  on('numbers', showState);
}
