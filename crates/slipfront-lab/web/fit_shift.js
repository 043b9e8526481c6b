// @ts-check
// The shift in time that brings a measured record closest to a computed curve.

/** Shifts that are tried over all that may be meant, and those of them that are refined. */
const TRIED = 1500;
const REFINED = 5;
/** More values of a record than these decide nothing. */
const MOST = 500;
/** Steps of the golden section, each of which leaves 0.62 of the interval: 60 leave less than 1e-12. */
const STEPS = 60;
const GOLDEN = (Math.sqrt(5) - 1) / 2;

/** @typedef {{t: number[], mu: number[]}} Curve */

/** Some values of a curve, at equal distances in the list. @param {Curve} curve @returns {Curve} */
function thinned({ t, mu }) {
  const stride = Math.ceil(t.length / MOST);
  const isKept = (/** @type {number} */ _, /** @type {number} */ k) => k % stride === 0;
  return { t: t.filter(isKept), mu: mu.filter(isKept) };
}

/** The mean square of record minus curve where both have values; infinite where that is less than half of the record. @param {Curve} record @param {Curve} curve @param {number} shift */
function distance(record, curve, shift) {
  const last = curve.t.length - 1;
  let [sum, count, at] = [0, 0, 0];
  for (let k = 0; k < record.t.length; k += 1) {
    const t = record.t[k] + shift;
    if (t < curve.t[0] || t > curve.t[last]) continue;
    while (at < last - 1 && curve.t[at + 1] < t) at += 1;
    const width = curve.t[at + 1] - curve.t[at];
    const share = width > 0 ? (t - curve.t[at]) / width : 0;
    const difference = record.mu[k] - (curve.mu[at] + share * (curve.mu[at + 1] - curve.mu[at]));
    sum += difference * difference;
    count += 1;
  }
  return 2 * count >= record.t.length ? sum / count : Infinity;
}

/** Where a function is least between two ends, by the golden section. @param {(x: number) => number} of @param {number} low @param {number} high */
function least(of, low, high) {
  let [left, right] = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
  let [atLeft, atRight] = [of(left), of(right)];
  for (let step = 0; step < STEPS; step += 1) {
    if (atLeft < atRight) {
      [high, right, atRight] = [right, left, atLeft];
      left = high - GOLDEN * (high - low);
      atLeft = of(left);
    } else {
      [low, left, atLeft] = [left, right, atRight];
      right = low + GOLDEN * (high - low);
      atRight = of(right);
    }
  }
  return atLeft < atRight ? left : right;
}

/**
 * The shift, in t*, that added to the times of the record makes the mean square of its distance from the curve least, where they overlap by
 * at least half of the record; null if no shift does that. The times of both rise.
 * @param {Curve} measured @param {Curve} curve
 */
export function fittedShift(measured, curve) {
  if (measured.t.length < 2 || curve.t.length < 2) return null;
  const record = thinned(measured);
  const of = (/** @type {number} */ shift) => distance(record, curve, shift);
  const [first, end] = [record.t[0], record.t[record.t.length - 1]];
  const [from, to] = [curve.t[0] - end, curve.t[curve.t.length - 1] - first];
  const step = (to - from) / TRIED;
  const tried = Array.from({ length: TRIED + 1 }, (_, k) => from + k * step).map((shift) => ({ shift, is: of(shift) }));
  const best = tried.filter(({ is }) => Number.isFinite(is)).sort((one, other) => one.is - other.is).slice(0, REFINED);
  if (best.length === 0) return null;
  const refined = best.map(({ shift }) => least(of, shift - step, shift + step)).map((shift) => ({ shift, is: of(shift) }));
  return [...refined, ...best].reduce((one, other) => (other.is < one.is ? other : one)).shift;
}
