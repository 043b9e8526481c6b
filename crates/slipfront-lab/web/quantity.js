// @ts-check
// Numbers and quantities as text: with the prefixes of SI for people, and as the case file writes lengths.

const PREFIXES = { f: 1e-15, p: 1e-12, n: 1e-9, u: 1e-6, '\u00b5': 1e-6, '\u03bc': 1e-6, m: 1e-3, c: 1e-2, d: 1e-1, '': 1, h: 1e2, k: 1e3, M: 1e6, G: 1e9, T: 1e12 };
const SHOWN = [[1e12, 'T'], [1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, '\u00b5'], [1e-9, 'n'], [1e-12, 'p'], [1e-15, 'f']];

/** A number with `digits` significant digits and a true minus. @param {number} value */
export function number(value, digits = 3) {
  if (!Number.isFinite(value)) return '\u2013';
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(digits - 1).replace(/\.?0*e\+?/, 'e') : String(Number(value.toPrecision(digits)));
  return text.replaceAll('-', '\u2212');
}

/** A number with `digits` digits after the point and a true minus; a dash if there is none. @param {number|null|undefined} value */
export function fixed(value, digits = 3) {
  return value === null || value === undefined || !Number.isFinite(value) ? '\u2013' : value.toFixed(digits).replace('-', '\u2212');
}

/** The prefix of SI in which `value` has one to three digits before the point. @param {number} value @returns {[number, string]} */
export function prefix(value) {
  const size = Math.abs(value);
  const found = SHOWN.find(([factor]) => size >= Number(factor) * 0.9995);
  return /** @type {[number, string]} */ (size === 0 ? [1, ''] : found ?? SHOWN[SHOWN.length - 1]);
}

/** A quantity in the prefix that suits it: 0.0379 m/s is 37.9 mm/s. @param {number} value @param {string} unit */
export function quantity(value, unit, digits = 3) {
  if (unit === '' || unit === '1') return number(value, digits);
  if (!/^(m|s|Pa|N|m\/s)$/.test(unit)) return `${number(value, digits)} ${unit}`;
  const [factor, letter] = prefix(value);
  return `${number(value / factor, digits)} ${letter}${unit}`;
}

/** A length of the case file, `"25 um"`, in metres; null if it is none. @param {string} [text] */
export function metres(text = '') {
  const match = /^\s*([-+]?[\d.]+(?:e[-+]?\d+)?)\s*([fpnu\u00b5\u03bcmcdhkMGT]?)m\s*$/i.exec(text);
  const value = match ? Number(match[1]) * PREFIXES[/** @type {keyof typeof PREFIXES} */ (match[2])] : NaN;
  return Number.isFinite(value) ? value : null;
}

/** Metres as the case file writes them, in micrometres to a picometre. @param {number} value */
export const length = (value) => `${Number((value * 1e6).toFixed(6))} um`;

/** What was typed as a number, with a point or a comma and any minus; null if it is none. @param {string} text */
export function typed(text) {
  const value = Number(text.trim().replace(',', '.').replace('\u2212', '-'));
  return text.trim() === '' || !Number.isFinite(value) ? null : value;
}

/** About four round numbers from `low` to `high`. @param {number} low @param {number} high */
export function ticks(low, high, count = 4) {
  if (!(high > low)) return [low];
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((size) => size >= rough * 0.999) ?? 10 * power;
  const from = Math.ceil(low / step - 1e-9);
  const until = Math.floor(high / step + 1e-9);
  return Array.from({ length: until - from + 1 }, (_, k) => Number(((from + k) * step).toPrecision(12)));
}
