// @ts-check
// The curves mu*(t*) and N*(t*), with the instants, the beginnings of legs, the slider without texture and a recorded curve.
import vendored from './vendor/uPlot.esm.js';
import { atMost, find } from './element.js';
import { on, state } from './store.js';
import { say } from './text.js';
import { colour, onTheme } from './theme.js';

/** @import { CurveReply } from '../types/protocol' */
/** @import { Scale, Series, uPlot } from '../types/uplot' */

const Plot = /** @type {typeof uPlot} */ (/** @type {unknown} */ (vendored));

const SPACING_MS = 200;
/** With more points than this every second one is left out: no screen shows more. */
const MOST = 20_000;

/** @typedef {{t: number[], mu: number[], sliding: number[]}} Run */
/** @type {Run} */
const run = { t: [], mu: [], sliding: [] };
/** @type {Run} */
const twin = { t: [], mu: [], sliding: [] };
/** @type {Run} */
const recorded = { t: [], mu: [], sliding: [] };
/** Where legs begin, t* since rest. @type {number[]} */
const legs = [];
/** @type {uPlot[]} */
let plots = [];

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

/** Vertical lines: dashed where legs begin, dotted with a letter at the instants. @param {uPlot} plot */
function marks(plot) {
  const { ctx: context, bbox: { top, height, left, width } } = plot;
  const ratio = devicePixelRatio;
  const line = (/** @type {number} */ t, /** @type {number[]} */ dashes, /** @type {string} */ name) => {
    const x = Math.round(plot.valToPos(t, 'x', true));
    if (x < left || x > left + width) return;
    context.setLineDash(dashes.map((dash) => dash * ratio));
    context.beginPath();
    context.moveTo(x, top);
    context.lineTo(x, top + height);
    context.stroke();
    context.fillText(name, x + 2 * ratio, top + 2 * ratio);
  };
  context.save();
  context.strokeStyle = colour('muted');
  context.fillStyle = colour('text');
  context.font = `${11 * ratio}px system-ui, sans-serif`;
  context.textAlign = 'left';
  context.textBaseline = 'top';
  legs.forEach((t) => line(t, [6, 4], ''));
  Object.entries(state.numbers?.instants ?? {}).forEach(([letter, t]) => line(t, [2, 3], letter));
  context.restore();
}

/** @param {string} label @param {boolean} numbered whether t* is written below */
function axes(label, numbered) {
  const shared = { stroke: () => colour('text'), grid: { stroke: () => colour('grid'), width: 1 }, ticks: { stroke: () => colour('grid'), width: 1, size: 4 }, font: '11px system-ui, sans-serif', labelFont: '12px system-ui, sans-serif' };
  return [
    { ...shared, size: numbered ? 22 : 8, label: numbered ? say('axis_t') : undefined, labelSize: 16, ...(numbered ? {} : { values: () => [] }) },
    { ...shared, size: 40, gap: 3, label, labelSize: 16 },
  ];
}

/** @param {string} name @param {() => string} stroke @param {number[]} dash */
const series = (name, stroke, dash = []) => ({ label: name, stroke, dash, width: 1.5, spanGaps: true, points: { show: false } });

/** @param {HTMLElement} place @param {{scale: Scale, label: string, lines: Series[], numbered: boolean}} options */
function plotIn(place, { scale, label, lines, numbered }) {
  return new Plot({
    width: place.clientWidth,
    height: place.clientHeight,
    padding: [6, 8, 0, 0],
    legend: { show: false },
    cursor: { sync: { key: 'time' }, drag: { x: true, y: false }, points: { size: 6 } },
    scales: { x: { time: false }, y: scale },
    axes: axes(label, numbered),
    series: [{ label: 't*' }, ...lines],
    hooks: { draw: [marks], setCursor: [showCursor] },
  }, [[], ...lines.map(() => [])], place);
}

/** Tells the values under the cursor. @param {uPlot} plot */
function showCursor(plot) {
  const { idx } = plot.cursor;
  if (plot !== plots[0]) return;
  const [t, mu] = idx === null || idx === undefined ? [] : [plot.data[0][idx], plot.data[1][idx]];
  find('curve-cursor').textContent = t === null || t === undefined || mu === null || mu === undefined ? '' : say('curve_cursor', { t: t.toFixed(1), mu: mu.toFixed(3) });
}

function draw() {
  if (plots.length === 0) return;
  // Both plots have all times, so that one stands below the other.
  const [t, mu, sliding, ...others] = Plot.join([[run.t, run.mu, run.sliding], [twin.t, twin.mu], [recorded.t, recorded.mu]]);
  plots[0].setData([t, mu, ...others]);
  plots[1].setData([t, sliding]);
  find('curve-twin').hidden = twin.t.length === 0;
  find('curve-recorded').hidden = recorded.t.length === 0;
}
const refresh = atMost(draw, SPACING_MS);

function fit() {
  for (const plot of plots) {
    const place = plot.root.parentElement;
    if (place && place.clientWidth > 0 && place.clientHeight > 0) plot.setSize({ width: place.clientWidth, height: place.clientHeight });
  }
}

/** The canvases of the curves, from top to bottom. @returns {HTMLCanvasElement[]} */
export const curveCanvases = () => plots.map((plot) => plot.ctx.canvas);

/** The points of the newest run, for those who look at them. */
export const curvePoints = () => run;

/** Prepares the plots. */
export function startCurves() {
  const lines = [
    series('run', () => colour('curve')),
    series('twin', () => colour('ghost'), [6, 3]),
    series('recorded', () => colour('recorded'), [2, 3]),
  ];
  plots = [
    plotIn(find('plot-mu'), { label: say('axis_mu'), lines, numbered: false, scale: { range: (_, low, high) => [Math.min(0, low ?? 0), 1.08 * Math.max(high ?? 0, 0.1)] } }),
    plotIn(find('plot-sliding'), { label: say('axis_sliding'), lines: [series('run', () => colour('curve'))], numbered: true, scale: { range: [0, 100] } }),
  ];
  on('curve', take);
  on('case', ({ why, twin: compared }) => {
    if (why === 'open') clear(recorded);
    if (why === 'open' || !compared) clear(twin);
    refresh();
  });
  new ResizeObserver(fit).observe(find('plot-mu'));
  onTheme(() => plots.forEach((plot) => plot.redraw(false, true)));
}
