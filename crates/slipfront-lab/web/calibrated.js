// @ts-check
// What a calibration has found: the verdict on the model, each unknown with its interval, the report, and what
// to do with the numbers.
import { send } from './connection.js';
import { change, newGesture } from './edit.js';
import { download, find, make, onPress } from './element.js';
import { number } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';

/** @import { CalibrationResults, UnknownReply } from '../types/protocol' */

/** @type {CalibrationResults|null} */
let found = null;
/** The name of the record's file. */
let record = '';

/**
 * @param {UnknownReply} unknown
 * @param {boolean} refused
 */
function row({ key, unit, median, interval: [low, high], is_determined: determined }, refused) {
  const behind = unit === null || unit === '1' || unit === '' ? '' : ` ${unit}`;
  const cells = [`${number(median)}${behind}`, `${number(low)} ${say('range_to')} ${number(high)}${behind}`, say(refused ? 'not_of_record' : determined ? 'determined' : 'not_determined')];
  // A long key is broken behind its table, where there is little room.
  const [table, ...parts] = key.split('.');
  return make('tr', {}, [make('th', { scope: 'row' }, [`${table}.`, make('wbr'), parts.join('.')]), ...cells.map((textContent) => make('td', { textContent }))]);
}

/** @param {CalibrationResults} results */
function show(results) {
  found = results;
  find('verdict').textContent = say(results.is_refused ? 'verdict_refused' : 'verdict_accepted');
  find('verdict').classList.toggle('refused', results.is_refused);
  find('found-numbers').replaceChildren(...results.unknowns.map((unknown) => row(unknown, results.is_refused)));
  find('calibration-report').textContent = results.report;
  // Of a refused record it is the report that says what the model lacks.
  find('calibration-more').open = results.is_refused;
  find('calibration-command').textContent = `slipfront calibrate calibration.toml ${quoted(record)}`;
}

/** A name as a shell takes it for one word. @param {string} name */
const quoted = (name) => (/^[\w.,+-]+$/.test(name) ? name : `'${name.replaceAll("'", "'\\''")}'`);

/** Gives the case the medians. */
function use() {
  find('calibrated').close();
  if (found) change(found.set);
}

/** Prepares the dialog. */
export function startCalibrated() {
  onPress('show-calibrated', () => find('calibrated').showModal());
  onPress('use-numbers', use);
  onPress('use-and-find', () => {
    use();
    send({ do: 'find', gesture: newGesture() });
    find('find').focus();
  });
  onPress('download-calibration', () => found && download(new Blob([found.toml], { type: 'application/toml' }), 'calibration.toml'));
  const showRow = () => (find('calibrated-row').hidden = found === null || Boolean(state.calibrating));
  on('calibrating', (calibrating) => {
    // Another record may be shown when it ends.
    if (calibrating && find('calibrated-row').dataset.busy !== 'yes') record = state.measured?.file.name ?? '';
    find('calibrated-row').dataset.busy = calibrating ? 'yes' : '';
    showRow();
  });
  on('calibrated', ({ results }) => {
    if (results) show(results);
    showRow();
  });
  on('measured', (measured) => {
    if (!measured) found = null;
    showRow();
  });
}
