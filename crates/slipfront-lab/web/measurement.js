// @ts-check
// The file of a measured record, dropped on the page or chosen: the session reads its table, and where it
// cannot, a dialog asks for columns and units. The record stays, whichever case is shown, until it is removed.
import { toBase64 } from './base64.js';
import { send } from './connection.js';
import { find, make, onPress } from './element.js';
import { announce, notice } from './notices.js';
import { MOST_BYTES } from './run_folder.js';
import { on, put, state } from './store.js';
import { say } from './text.js';

/** @import { RecordCurve, RecordFile, RecordReply } from '../types/protocol' */

// Any other file may be a table: instruments have endings of their own, and the reader tells what it found.
const PICTURE = /\.(png|jpe?g|gif|webp|avif|bmp|tiff?|svg)$/i;

/** The file that was given to be read last. @type {RecordFile|null} */
let asked = null;
/** The file whose columns the dialog shows. @type {RecordFile|null} */
let shown = null;

/** @param {RecordFile} record */
function ask(record) {
  asked = record;
  send({ do: 'read_record', record });
}

/** Gives the bytes of a file to be read as a record. @param {string} name @param {Uint8Array} bytes */
export const readRecord = (name, bytes) => ask({ name, bytes: toBase64(bytes) });

/** Reads a file as a record; false if it is a picture by its name. @param {File} file */
export function openRecord(file) {
  if (PICTURE.test(file.name)) return false;
  const most = MOST_BYTES / 2 ** 20;
  if (file.size > MOST_BYTES) notice(say('record_too_large', { name: file.name, most }));
  else file.arrayBuffer().then((bytes) => readRecord(file.name, new Uint8Array(bytes))).catch(() => notice(say('record_unreadable', { name: file.name })));
  return true;
}

/** @param {string} sentence */
function problem(sentence) {
  find('measure-problem').textContent = sentence;
  if (sentence && !find('measure').open) find('measure').showModal();
}

/** Places of the columns to begin with: those that were asked for, or the first ones with fitting units. @param {RecordFile} file @param {RecordReply} record */
function placesOf({ x, y }, { columns, curve }) {
  if (curve) return curve.columns;
  const first = (/** @type {RegExp} */ unit, other = -1) => columns.findIndex((column, k) => k !== other && unit.test(column.unit ?? ''));
  const along = x === undefined ? Math.max(first(/^(.?s|min|h|.?m)$/), 0) : Number(x) - 1;
  const friction = first(/^(.?N|1|%)$/, along);
  return [along, y === undefined ? (friction < 0 ? (along === 0 ? 1 : 0) : friction) : Number(y) - 1];
}

/** Offers the columns of a table. @param {RecordFile} file @param {RecordReply} record */
function fillColumns(file, record) {
  const { name, columns, notes } = record;
  shown = file;
  find('measure-columns').hidden = columns.length < 2;
  find('measure-file').textContent = say('measure_file', { name });
  find('measure-notes').textContent = notes.join(' ');
  const chosen = placesOf(file, record);
  for (const [id, unit, place] of /** @type {Array<['record-x'|'record-y', 'record-x-unit'|'record-y-unit', number]>} */ ([['record-x', 'record-x-unit', 0], ['record-y', 'record-y-unit', 1]])) {
    const texts = columns.map((column, k) => say(column.unit === null ? 'column' : 'column_unit', { number: k + 1, name: column.name, unit: column.unit ?? '' }));
    find(id).replaceChildren(...texts.map((textContent, k) => make('option', { value: String(k + 1), textContent })));
    find(id).value = String(chosen[place] + 1);
    find(unit).value = (place === 0 ? file.x_unit : file.y_unit) ?? '';
  }
}

/** What was added to the times of this file before stays added. @param {RecordFile} file @param {RecordCurve} curve */
function shiftOf(file, curve) {
  const before = state.measured;
  return before && before.file.bytes === file.bytes && before.curve.along === curve.along ? before.shift : 0;
}

/** @param {RecordReply} record */
function take(record) {
  if (!asked) return;
  const file = asked;
  asked = null;
  fillColumns(file, record);
  if (record.curve === null) return problem(record.problem ?? '');
  problem('');
  find('measure').close();
  put('measured', { file, curve: record.curve, shift: shiftOf(file, record.curve) });
  const { name, notes } = record;
  const text = say('record_drawn', { name, values: record.curve.values });
  notice([text, ...notes].join(' '), { topic: 'record' });
  announce(text);
}

/** Reads the file anew, with the columns and units that were chosen. @param {SubmitEvent} event */
function readAgain(event) {
  event.preventDefault();
  if (!shown) return;
  const { name, bytes } = shown;
  const units = [find('record-x-unit').value.trim(), find('record-y-unit').value.trim()];
  ask({ name, bytes, x: find('record-x').value, y: find('record-y').value, ...(units[0] && { x_unit: units[0] }), ...(units[1] && { y_unit: units[1] }) });
}

function remove() {
  put('measured', null);
  shown = null;
  problem('');
  find('measure').close();
}

/** Prepares the dialog. */
export function startMeasurement() {
  onPress('open-measure', () => {
    problem('');
    if (!state.measured) find('measure-columns').hidden = true;
    find('measure').showModal();
  });
  onPress('choose-record', () => find('record-file').click());
  onPress('remove-record', remove);
  find('record-file').addEventListener('change', () => {
    const file = find('record-file').files?.[0];
    if (file && !openRecord(file)) problem(say('record_unreadable', { name: file.name }));
    find('record-file').value = '';
  });
  find('measure-columns').addEventListener('submit', readAgain);
  on('record', take);
  on('refused', ({ of, sentence }) => {
    if (of === 'read_record' && find('measure').open) problem(sentence);
  });
  on('measured', (measured) => (find('remove-record').hidden = measured === null));
}
