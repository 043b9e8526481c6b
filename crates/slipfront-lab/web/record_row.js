// @ts-check
// The row below the head of the curves while a measured record is shown: its shift, by hand or fitted, and
// whether it can be compared with the curve.
import { curvePoints } from './curves.js';
import { find, onPress } from './element.js';
import { fittedShift } from './fit_shift.js';
import { notice } from './notices.js';
import { alongUnit, inStars, unitOf } from './record.js';
import { on, put, state } from './store.js';
import { say } from './text.js';

/** Steps of the shift by hand over the length of a record. */
const STEPS = 200;
/** Digits of a shift that is shown: more than a curve on a screen has. */
const DIGITS = 5;

function show() {
  const { measured } = state;
  find('measured-row').hidden = !measured;
  if (!measured) return;
  const { x } = measured.curve;
  const [factor, unit] = unitOf(measured.curve);
  find('shift-unit').textContent = unit;
  find('shift').step = String(Number(((x[x.length - 1] - x[0]) / factor / STEPS).toPrecision(1)));
  // What is being typed stays.
  if (document.activeElement !== find('shift')) find('shift').value = String(Number((measured.shift / factor).toPrecision(DIGITS)));
  const cannot = state.case && !inStars(measured.curve, 0, state.case);
  find('measured-note').textContent = cannot ? say(`not_comparable_${measured.curve.of}`) : '';
}

/** @param {number} shift */
function setShift(shift) {
  if (state.measured) put('measured', { ...state.measured, shift });
}

function fit() {
  const { measured, case: shown } = state;
  if (!measured || !shown) return;
  const [record, unit] = [inStars(measured.curve, 0, shown), alongUnit(measured.curve, shown)];
  const shift = record && fittedShift(record, curvePoints());
  if (shift === null || unit === null) notice(say('shift_not_fitted'), { topic: 'record' });
  else setShift(shift * unit);
}

/** Prepares the row. */
export function startRecordRow() {
  find('shift').addEventListener('input', () => {
    const value = find('shift').valueAsNumber;
    if (Number.isFinite(value) && state.measured) setShift(value * unitOf(state.measured.curve)[0]);
  });
  onPress('fit-shift', fit);
  on('measured', show);
  on('case', show);
}
