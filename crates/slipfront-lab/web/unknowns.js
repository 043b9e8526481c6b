// @ts-check
// Quantities of a case that a calibration may look for, with ranges around their present values.
import { prefix } from './quantity.js';

/** @import { CaseReply, CaseValue } from '../types/protocol' */

/** A quantity that may be unknown; its ends are null where the case does not tell its present value. @typedef {{id: string, key: string, unit: string, logarithmic: boolean, from: number|null, to: number|null}} Unknown */

/** How many unknowns one record may be asked for on the page. */
export const COUNTS = [2, 4];

/** Two digits are enough for an end of a range. @param {number} value */
const rounded = (value) => Number(value.toPrecision(2));

/** @param {number} value @param {number} low @param {number} high */
const within = (value, low, high) => Math.min(Math.max(value, low), high);

/** A range from a fraction of a value to a multiple of it. @param {number|null|undefined} value @param {number} factor */
function about(value, factor) {
  const known = value !== null && value !== undefined && value > 0 && Number.isFinite(value);
  return known ? { from: rounded(value / factor), to: rounded(value * factor) } : { from: null, to: null };
}

/** The stiffness of all drive springs together, N/m: what makes mu* rise while nothing slides. @param {CaseReply} shown */
function stiffness({ loading_rate: rate, units, values }) {
  const speed = values.speed?.si;
  return rate === null || units.friction_n === null || !speed ? null : (rate * units.friction_n) / (units.time_s * speed);
}

/** The quantities that are offered for a case. @param {CaseReply} shown @returns {Unknown[]} */
export function unknownsOf(shown) {
  const { units, values } = shown;
  const [r, sigma] = [values.r_star?.star ?? 0.5, values.sigma?.star ?? 0.05];
  const pressure = values.load?.si ?? null;
  const [factor, letter] = prefix(pressure ?? 0);
  const plain = { unit: '', logarithmic: false };
  return [
    { id: 'mu_static', key: 'friction.mu_static', ...plain, ...about(units.friction_coefficient, 1.7) },
    { id: 'r_star', key: 'friction.r_star', ...plain, from: rounded(within(r - 0.3, 0.05, 0.9)), to: rounded(within(r + 0.3, 0.1, 0.98)) },
    { id: 'damping_rate', key: 'slider.damping_rate', unit: '1/s', logarithmic: true, ...about(values.omega_star?.si || 0.1 / units.time_s, 4) },
    { id: 'total_stiffness', key: 'drive.total_stiffness', unit: 'N/m', logarithmic: true, ...about(stiffness(shown), 2) },
    { id: 'pressure', key: 'load.pressure', unit: `${letter}Pa`, logarithmic: true, ...about(pressure && pressure / factor, 2) },
    { id: 'sigma', key: 'friction.sigma_static_star', ...plain, from: 0.01, to: rounded(Math.max(0.15, 2 * sigma)) },
  ];
}

/** An end of a range as it stands in its field. @param {number|null} value */
export const endText = (value) => (value === null ? '' : value >= 1e5 || value < 1e-3 ? value.toExponential().replace('e+', 'e') : String(value));

/** A range as a calibration file has it. @param {Unknown} unknown @param {number} from @param {number} to @returns {CaseValue} */
export function rangeOf({ unit, logarithmic }, from, to) {
  const [low, high] = [from, to].map((value) => (unit === '' ? value : `${value} ${unit}`));
  return logarithmic ? { from: low, to: high, scale: 'log' } : [low, high];
}
