// @ts-check
// A measured record in the units of the curves, t* and mu*, for the case that is shown.

import { prefix } from './quantity.js';

/** @import { CaseReply, RecordCurve } from '../types/protocol' */

/** Seconds or metres of a record in one t*; null if the drive does not tell them. @param {RecordCurve} curve @param {Pick<CaseReply, 'units'|'values'>} shown */
export function alongUnit({ along }, { units, values }) {
  const unit = along === 'time' ? units.time_s : units.displacement_m * (values.speed?.star ?? 0);
  return unit > 0 ? unit : null;
}

/**
 * A record as a curve mu*(t*), with so many seconds or metres added to its times or displacements; null where it cannot be compared, such
 * as a force with a slider that is turned.
 * @param {RecordCurve} curve @param {number} shift @param {Pick<CaseReply, 'units'|'values'>} shown
 */
export function inStars(curve, shift, shown) {
  const along = alongUnit(curve, shown);
  const { friction_n: force, friction_coefficient: coefficient } = shown.units;
  const friction = curve.of === 'force' ? force : coefficient;
  if (along === null || friction === null) return null;
  return { t: curve.x.map((x) => (x + shift) / along), mu: curve.y.map((y) => y / friction) };
}

/** The prefix of SI that suits the times or displacements of a record, and the unit with it. @param {RecordCurve} curve @returns {[number, string]} */
export function unitOf({ x, along }) {
  const [factor, letter] = prefix(Math.max(Math.abs(x[0]), Math.abs(x[x.length - 1])));
  return [factor, `${letter}${along === 'time' ? 's' : 'm'}`];
}

/** A share that is rounded up to two digits, at least 0.1 %: noise that is taken for weaker than it is makes intervals too narrow. @param {number} percent */
export function roundedUp(percent) {
  const size = Math.max(percent, 0.1);
  const digit = 10 ** (Math.floor(Math.log10(size)) - 1);
  // What is below a billionth of a digit is rounding.
  return Number((Math.ceil(size / digit - 1e-9) * digit).toPrecision(2));
}
