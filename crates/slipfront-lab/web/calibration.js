// @ts-check
// "Find the numbers": which quantities of the case are unknown and in which ranges, how a calibration of them
// goes, and that it can be stopped.
import { send } from './connection.js';
import { find, make, onPress } from './element.js';
import { announce, notice } from './notices.js';
import { typed } from './quantity.js';
import { roundedUp, unitOf } from './record.js';
import { on, presentCase, put, state } from './store.js';
import { say } from './text.js';
import { COUNTS, endText, rangeOf, unknownsOf } from './unknowns.js';

/** @import { CalibratedReply, CalibratingReply, CaseValue, RecordCurve } from '../types/protocol' */
/** @import { Unknown } from './unknowns.js' */

/** Unknowns that are chosen at first: every record of a slider that begins to slide tells of them. */
const CHOSEN = ['mu_static', 'r_star'];

/** @param {Unknown} unknown */
function row(unknown) {
  const name = say(`unknown_${unknown.id}`);
  const id = `unknown-${unknown.id}`;
  const check = make('input', { type: 'checkbox', id, checked: CHOSEN.includes(unknown.id) });
  const label = make('label', { for: id }, [`${name} `, make('code', { textContent: unknown.key })]);
  const [from, to] = ['from', 'to'].map((end) => {
    const field = make('input', { type: 'text', inputMode: 'decimal', id: `${id}-${end}`, autocomplete: 'off', 'aria-label': say(`unknown_${end}`, { name }) });
    // What was typed stays when another case is shown.
    field.addEventListener('input', () => (field.dataset.typed = 'yes'));
    return field;
  });
  const unit = make('span', { className: 'unit' });
  check.addEventListener('change', showCount);
  const element = make('div', { className: 'unknown' }, [check, label, make('span', {}, [from, ` ${say('range_to')} `, to, ' ', unit])]);
  return { unknown, name, element, check, from, to, unit };
}

/** @type {ReturnType<typeof row>[]} */
let rows = [];

/** The ends of the ranges around the present values, where nothing was typed. */
function fillRanges() {
  const offered = unknownsOf(presentCase());
  if (rows.length === 0) {
    rows = offered.map(row);
    find('unknowns').replaceChildren(...rows.map(({ element }) => element));
  }
  rows.forEach((made, k) => {
    made.unknown = offered[k];
    made.unit.textContent = offered[k].unit;
    for (const end of /** @type {const} */ (['from', 'to'])) if (!made[end].dataset.typed) made[end].value = endText(offered[k][end]);
  });
}

const chosen = () => rows.filter(({ check }) => check.checked);

function showCount() {
  const count = chosen().length;
  const fits = count >= COUNTS[0] && count <= COUNTS[1];
  find('calibrate-start').disabled = !fits || Boolean(state.calibrating);
  find('calibrate-count').textContent = say(fits ? 'calibrate_count' : 'calibrate_count_wrong', { count });
}

/** @param {string} sentence */
const problem = (sentence) => (find('calibrate-problem').textContent = sentence);

/** The ranges of the chosen unknowns; null after a problem was said. @returns {Record<string, CaseValue>|null} */
function ranges() {
  const found = /** @type {Record<string, CaseValue>} */ ({});
  for (const { unknown, name, from, to } of chosen()) {
    const [low, high] = [typed(from.value), typed(to.value)];
    if (low === null || high === null || low >= high) {
      problem(say('range_wrong', { name }));
      (low === null ? from : to).focus();
      return null;
    }
    found[unknown.key] = rangeOf(unknown, low, high);
  }
  return found;
}

/** The part of the record that counts, in s or m after the shift; null after a problem was said. @param {RecordCurve} curve @returns {{ from?: number, to?: number }|null} */
function part(curve) {
  const [factor] = unitOf(curve);
  const part = /** @type {{ from?: number, to?: number }} */ ({});
  for (const end of /** @type {const} */ (['from', 'to'])) {
    const text = find(`calibrate-${end}`).value;
    const value = typed(text);
    // Text that is no number is no empty field, which stands for an end of the record.
    if (text.trim() !== '') part[end] = value === null ? NaN : value * factor;
  }
  const { from = -Infinity, to = Infinity } = part;
  if (from < to) return part;
  problem(say('part_wrong'));
  find('calibrate-from').focus();
  return null;
}

/** @param {SubmitEvent} event */
function begin(event) {
  event.preventDefault();
  problem('');
  const unknowns = ranges();
  const counts = unknowns && state.measured && part(state.measured.curve);
  if (!state.measured || !unknowns || !counts) return;
  const { file, shift } = state.measured;
  // Until the session has answered.
  find('calibrate-start').disabled = true;
  send({ do: 'calibrate', record: file, shift, ...counts, noise: find('calibrate-noise').valueAsNumber / 100, runs: find('calibrate-runs').valueAsNumber, unknowns });
}

/** @param {CalibratingReply|null} calibrating */
function showProgress(calibrating) {
  find('calibrating-row').hidden = !calibrating;
  if (rows.length > 0) showCount();
  if (!calibrating) return;
  find('calibrate').close();
  const { stage, runs, of } = calibrating;
  find('calibrating-state').textContent = say('calibrating', { stage: say(`stage_${stage}`), runs, of });
  find('calibrating-progress').max = Math.max(of, 1);
  find('calibrating-progress').value = runs;
}

/** Says how a calibration has ended, if it has found nothing. @param {CalibratedReply} calibrated */
function end({ outcome, sentence }) {
  put('calibrating', null);
  // One of the ranges may be the reason.
  if (outcome === 'failed' && find('calibrate').open) return problem(sentence?.split('\n')[0] ?? '');
  if (outcome === 'failed') return notice(say('calibration_failed', { sentence: sentence ?? '' }), { topic: 'calibration', serious: true });
  const text = say(`calibration_${outcome}`);
  announce(text);
  if (outcome !== 'done') notice(text, { topic: 'calibration' });
}

/** Prepares the dialog. */
export function startCalibration() {
  onPress('open-calibrate', () => {
    problem('');
    fillRanges();
    showCount();
    find('calibrate-record').textContent = say('calibrate_record', { name: state.measured?.file.name ?? '', values: state.measured?.curve.values ?? 0 });
    find('calibrate').showModal();
  });
  find('calibrate-form').addEventListener('submit', begin);
  onPress('calibrating-stop', () => send({ do: 'calibrate_stop' }));
  const give = () => put('calibrating', null);
  /** The record with the noise and the part in the fields. @type {object|null} */
  let noisy = null;
  on('measured', (measured) => {
    if (!measured) find('calibrate').close();
    else if (measured.curve !== noisy) {
      find('calibrate-noise').value = String(roundedUp(measured.curve.noise_percent));
      find('calibrate-from').value = find('calibrate-to').value = '';
      find('calibrate-part-unit').textContent = unitOf(measured.curve)[1];
    }
    noisy = measured?.curve ?? null;
  });
  on('calibrating', showProgress);
  on('calibrated', end);
  on('connected', give);
  on('refused', ({ of, sentence }) => {
    if (of !== 'calibrate' || !find('calibrate').open) return;
    problem(sentence.split('\n')[0]);
    showCount();
  });
}
