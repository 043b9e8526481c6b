// @ts-check
// The curves mu*(t*) and N*(t*), with the instants, the beginnings of legs, the slider without texture, a
// recorded curve and a measured record.
import vendored from './vendor/uPlot.esm.js';
import { atMost, find } from './element.js';
import { rowsOf } from './letters.js';
import { inStars } from './record.js';
import { on, state } from './store.js';
import { say } from './text.js';
import { colour, enlargement, onTheme } from './theme.js';

/** @import { CurveReply } from '../types/protocol' */
/** @import { Scale, Series, uPlot } from '../types/uplot' */

const Plot = /** @type {typeof uPlot} */ (/** @type {unknown} */ (vendored));

const SPACING_MS = 200;
/** Sizes of the letters of instants and axes, in pixels of a small screen, and the room that a letter needs. */
const SMALL = 11;
const LABEL = 12;
const LETTER = 10;
/** Diameter of the points of a measured record. */
const DOT = 2.6;
/** Whether the page has one column, in which the plots do not stand one below the other. */
const oneColumn = matchMedia('(max-width: 899px)');
/** With more points than this every second one is left out: no screen shows more. */
const MOST = 20_000;

/** @typedef {{t: number[], mu: number[], sliding: number[]}} Run */
/** @type {Run} */
const run = { t: [], mu: [], sliding: [] };
/** @type {Run} */
const twin = { t: [], mu: [], sliding: [] };
/** @type {Run} */
const recorded = { t: [], mu: [], sliding: [] };
/** The points of the measured record as they are drawn; none if there is no record, or it cannot be compared. */
export const measuredPoints = () => (state.measured && state.case && inStars(state.measured.curve, state.measured.shift, state.case)) || { t: [], mu: [] };
/** Where legs begin, t* since rest. @type {number[]} */
const legs = [];
/** @type {uPlot[]} */
let plots = [];
/** By how much the letters of the plots are larger than on a small screen. */
let made = 1;

/** @param {Run} curve */
function clear(curve) {
  for (const list of Object.values(curve)) list.length = 0;
}

/** @param {Run} curve @param {number[]} t @param {number[]} mu @param {number[]} [sliding] */
function extend(curve, t, mu, sliding = []) {
  t.forEach((_, k) => {
    curve.t.push(t[k]);
    curve.mu.push(mu[k]);
    if (sliding.length > 0) curve.sliding.push(sliding[k]);
  });
  if (curve.t.length <= MOST) return;
  for (const key of /** @type {Array<keyof Run>} */ (['t', 'mu', 'sliding'])) curve[key] = curve[key].filter((_, k) => k % 2 === 0);
}

/** @param {CurveReply} message */
function take(message) {
  if (message.from_rest) {
    clear(run);
    legs.length = 0;
  }
  if (message.leg > legs.length) legs.push(message.t[0] ?? run.t.at(-1) ?? 0);
  extend(run, message.t, message.mu, message.sliding);
  if (message.twin_reset) clear(twin);
  extend(twin, message.twin_t, message.twin_mu);
  if (message.recorded_t && message.recorded_mu) {
    clear(recorded);
    extend(recorded, message.recorded_t, message.recorded_mu);
  }
  refresh();
}

/**
 * Vertical lines: dashed where legs begin, dotted with a letter at the instants; a letter that would lie on the one before stands below it.
 * @param {uPlot} plot @param {number} scale of letters and lines
 */
function marks(plot, scale) {
  const { ctx: context, bbox: { top, height, left, width } } = plot;
  const ratio = devicePixelRatio * scale;
  const place = (/** @type {number} */ t) => Math.round(plot.valToPos(t, 'x', true));
  const isSeen = (/** @type {number} */ x) => x >= left && x <= left + width;
  const line = (/** @type {number} */ t, /** @type {number[]} */ dashes) => {
    const x = place(t);
    if (!isSeen(x)) return;
    context.setLineDash(dashes.map((dash) => dash * ratio));
    context.beginPath();
    context.moveTo(x, top);
    context.lineTo(x, top + height);
    context.stroke();
  };
  // Above all lines, of which none shall cross it.
  const write = (/** @type {number} */ t, /** @type {string} */ letter, /** @type {number} */ row) => {
    if (!isSeen(place(t))) return;
    const [x, y] = [place(t) + 2 * ratio, top + (2 + row * (SMALL + 1)) * ratio];
    context.strokeText(letter, x, y);
    context.fillText(letter, x, y);
  };
  context.save();
  context.strokeStyle = colour('muted');
  context.fillStyle = colour('text');
  context.font = `${SMALL * ratio}px system-ui, sans-serif`;
  context.textAlign = 'left';
  context.textBaseline = 'top';
  legs.forEach((t) => line(t, [6, 4]));
  const instants = Object.entries(state.numbers?.instants ?? {}).sort(([, one], [, other]) => one - other);
  const rows = rowsOf(instants.map(([, t]) => plot.valToPos(t, 'x', true)), LETTER * ratio);
  instants.forEach(([, t]) => line(t, [2, 3]));
  context.setLineDash([]);
  context.lineWidth = 3 * ratio;
  context.strokeStyle = colour('page');
  instants.forEach(([letter, t], k) => write(t, letter, rows[k]));
  context.restore();
}

/** @param {string} label @param {boolean} numbered whether t* is written below @param {number} scale */
function axes(label, numbered, scale) {
  const shared = { stroke: () => colour('text'), grid: { stroke: () => colour('grid'), width: 1 }, ticks: { stroke: () => colour('grid'), width: 1, size: 4 }, font: `${SMALL * scale}px system-ui, sans-serif`, labelFont: `${LABEL * scale}px system-ui, sans-serif` };
  return [
    { ...shared, size: (numbered ? 22 : 8) * scale, label: numbered ? say('axis_t') : undefined, labelSize: 16 * scale, ...(numbered ? {} : { values: () => [] }) },
    { ...shared, size: 40 * scale, gap: 3, label, labelSize: 16 * scale },
  ];
}

/** @param {string} name @param {() => string} stroke @param {number} scale @param {number[]} dash */
const series = (name, stroke, scale, dash = []) => ({ label: name, stroke, dash: dash.map((length) => length * scale), width: 1.5 * scale, spanGaps: true, points: { show: false } });

/** @param {HTMLElement} place @param {[number, number]} size @param {number} scale @param {{range: Scale, label: string, lines: Series[], numbered: boolean}} options */
function plotIn(place, [width, height], scale, { range, label, lines, numbered }) {
  return new Plot({
    width,
    height,
    padding: [6 * scale, 14 * scale, 0, 0],
    legend: { show: false },
    cursor: { sync: { key: 'time' }, drag: { x: true, y: false }, points: { size: 6 } },
    scales: { x: { time: false }, y: range },
    axes: axes(label, numbered, scale),
    series: [{ label: 't*' }, ...lines],
    hooks: { draw: [(plot) => marks(plot, scale)], setCursor: [showCursor] },
  }, [[], ...lines.map(() => [])], place);
}

/** Points without a line between them. @param {string} name @param {() => string} stroke @param {number} scale @returns {Series} */
const dots = (name, stroke, scale) => ({ label: name, stroke, width: 0, paths: () => null, points: { show: true, size: DOT * scale, width: 0, fill: stroke } });

/** Both plots, of friction and of sliding. @param {[HTMLElement, HTMLElement]} places @param {[number, number][]} sizes @param {number} scale */
function plotsIn([above, below], [first, second], scale) {
  const curve = series('run', () => colour('curve'), scale);
  const lines = [
    curve,
    series('twin', () => colour('ghost'), scale, [6, 3]),
    series('recorded', () => colour('recorded'), scale, [2, 3]),
    dots('measured', () => colour('measured'), scale),
  ];
  return [
    plotIn(above, first, scale, { label: say('axis_mu'), lines, numbered: oneColumn.matches, range: { range: (_, low, high) => [Math.min(0, low ?? 0), 1.08 * Math.max(high ?? 0, 0.1)] } }),
    plotIn(below, second, scale, { label: say('axis_sliding'), lines: [curve], numbered: true, range: { range: [0, 100] } }),
  ];
}

/** The place nearest to another one where a list has a value. @param {(number|null|undefined)[]} list @param {number} place */
function nearest(list, place) {
  const has = (/** @type {number} */ k) => list[k] !== null && list[k] !== undefined;
  const distance = list.findIndex((_, k) => has(place - k) || has(place + k));
  return has(place - distance) ? place - distance : place + distance;
}

/** Tells the values under the cursor. @param {uPlot} plot */
function showCursor(plot) {
  const { idx } = plot.cursor;
  if (plot !== plots[0]) return;
  // Between two points of the run lie those of other curves.
  const at = idx === null || idx === undefined ? -1 : nearest(plot.data[1], idx);
  const [t, mu] = [plot.data[0][at], plot.data[1][at]];
  find('curve-cursor').textContent = t === null || t === undefined || mu === null || mu === undefined ? '' : say('curve_cursor', { t: t.toFixed(1), mu: mu.toFixed(3) });
}

/** Fills plots; gives the points of the measured record. @param {uPlot[]} of */
function fill([above, below]) {
  // Both plots have all times, so that one stands below the other.
  const record = measuredPoints();
  const [t, mu, sliding, ...others] = Plot.join([[run.t, run.mu, run.sliding], [twin.t, twin.mu], [recorded.t, recorded.mu], [record.t, record.mu]]);
  above.setData([t, mu, ...others]);
  below.setData([t, sliding]);
  return record;
}

function draw() {
  if (plots.length === 0) return;
  const measured = fill(plots);
  find('curve-twin').hidden = twin.t.length === 0;
  find('curve-recorded').hidden = recorded.t.length === 0;
  find('curve-measured').hidden = measured.t.length === 0;
  find('curve-letters').hidden = Object.keys(state.numbers?.instants ?? {}).length === 0;
}
const refresh = atMost(draw, SPACING_MS);

function fit() {
  if (enlargement() !== made) return make();
  for (const plot of plots) {
    const place = plot.root.parentElement;
    if (place && place.clientWidth > 0 && place.clientHeight > 0) plot.setSize({ width: place.clientWidth, height: place.clientHeight });
  }
}

/** The curves that there are: their names, colours and dashes. @returns {{name: string, stroke: string, dash: number[]}[]} */
export function curveLines() {
  const all = /** @type {Array<[{t: number[]}, string, string, number[]]>} */ ([[run, 'run', 'curve', []], [twin, 'twin', 'ghost', [6, 3]], [recorded, 'recorded', 'recorded', [2, 3]], [measuredPoints(), 'measured', 'measured', [2, 2]]]);
  return all.filter(([{ t }]) => t.length > 0).map(([, name, stroke, dash]) => ({ name: say(`curve_${name}`), stroke: colour(stroke), dash }));
}

/** Hands over canvases of the curves, from top to bottom, which are drawn for that in these sizes, in pixels. @param {[number, number][]} sizes @param {number} scale of letters and lines @param {(canvases: HTMLCanvasElement[]) => void} take */
export function drawCurves(sizes, scale, take) {
  const ratio = devicePixelRatio;
  const places = /** @type {[HTMLElement, HTMLElement]} */ ([document.createElement('div'), document.createElement('div')]);
  const drawn = plotsIn(places, sizes.map(([width, height]) => [width / ratio, height / ratio]), scale / ratio);
  fill(drawn);
  // They are drawn once what runs has ended.
  setTimeout(() => {
    take(drawn.map((plot) => plot.ctx.canvas));
    drawn.forEach((plot) => plot.destroy());
  });
}

/** The points of the newest run, for those who look at them. */
export const curvePoints = () => run;

/** Makes the plots, with letters of the size that the page has now. */
function make() {
  plots.forEach((plot) => plot.destroy());
  const places = /** @type {[HTMLElement, HTMLElement]} */ ([find('plot-mu'), find('plot-sliding')]);
  plots = plotsIn(places, places.map(({ clientWidth, clientHeight }) => [clientWidth, clientHeight]), enlargement());
  made = enlargement();
  draw();
}

/** Prepares the plots. */
export function startCurves() {
  make();
  on('curve', take);
  // The instants, which the curves name with letters, may come after the last points.
  on('numbers', refresh);
  on('measured', refresh);
  on('case', ({ why }) => {
    if (why === 'open') clear(recorded);
    refresh();
  });
  new ResizeObserver(fit).observe(find('plot-mu'));
  oneColumn.addEventListener('change', make);
  onTheme(() => plots.forEach((plot) => plot.redraw(false, true)));
}
