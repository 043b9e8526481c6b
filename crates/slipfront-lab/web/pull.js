// @ts-check
// How the slider is pulled: an arrow in the field tells whither, and a drawing from the side shows the far
// end of the spring, which moves steadily, and the slider, which waits until friction gives way.
import { find } from './element.js';
import { on, state } from './store.js';
import { say } from './text.js';

/** @import { CaseReply, CurveReply, NumbersReply } from '../types/protocol' */

/** Pixels of the drawing by which the spring is longer for each 1 of mu*, its length without force, and the end of the slider in the drawing. */
const PER_MU = 60;
const REST = 46;
const SLIDER_END = 70;
/** Height of the spring in the drawing, the half width of its coils, how many it has, and the distance of the marks on the ground. */
const HEIGHT = 17;
const COIL = 6;
const COILS = 8;
const MARKS = 20;

/** By how much the far end has moved, in units of mu*, and the time up to which it is known. */
let pulled = 0;
let time = 0;

/** The line of a spring between two places. @param {number} from @param {number} to */
function spring(from, to) {
  const coils = Array.from({ length: COILS }, (_, k) => {
    const x = from + ((to - from) * (k + 0.5)) / COILS;
    return `L${x.toFixed(1)} ${HEIGHT + (k % 2 === 0 ? -COIL : COIL)}`;
  });
  return `M${from} ${HEIGHT} ${coils.join(' ')} L${to.toFixed(1)} ${HEIGHT}`;
}

/** @param {number} mu */
function draw(mu) {
  const end = SLIDER_END + REST + PER_MU * mu;
  find('pull-spring').setAttribute('d', spring(SLIDER_END, end));
  find('pull-end').setAttribute('transform', `translate(${end.toFixed(1)} ${HEIGHT})`);
  // The slider stays where it is in the drawing: the ground passes below it.
  find('pull-ground').setAttribute('transform', `translate(${(-((PER_MU * (pulled - mu)) % MARKS)).toFixed(1)} 0)`);
}

/** @param {CurveReply} curve */
function take({ from_rest: fromRest, t, mu }) {
  if (fromRest) {
    [pulled, time] = [0, 0];
    draw(0);
  }
  if (t.length === 0) return;
  const last = t.length - 1;
  pulled += (state.case?.loading_rate ?? 0) * (t[last] - time);
  time = t[last];
  draw(mu[last]);
}

/** Says whether a block in contact has slipped, which is the instant B. @param {NumbersReply} numbers */
function showState({ instants }) {
  find('pull-state').textContent = say('B' in instants ? 'pull_slips' : 'pull_loads');
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
