// @ts-check
// Panels as pictures: the field with its title and colour bar, the curves, the kymograph.
import { drawBar, table } from './colours.js';
import { curveLines, drawCurves } from './curves.js';
import { find } from './element.js';
import { barInto, camera } from './field.js';
import { kymographAxes } from './kymograph.js';
import { fixed, number, prefix, ticks } from './quantity.js';
import { state } from './store.js';
import { say } from './text.js';
import { colour } from './theme.js';

const MARGIN = 12;
const TITLE = 24;
const BAR = 40;
/** Room for the numbers and the title of an axis beside and below a panel. */
const SIDE = 56;
const BELOW = 44;
/** Size of the picture of the curves, and pixels of a picture for each of its units. */
const CURVES = [800, 500];
const SCALE = 2;

/** An empty canvas in the colours of the page. @param {number} width @param {number} height @param {number} scale @returns {[HTMLCanvasElement, CanvasRenderingContext2D]} */
function blank(width, height, scale) {
  const canvas = document.createElement('canvas');
  canvas.width = 2 * Math.round((width * scale) / 2);
  canvas.height = 2 * Math.round((height * scale) / 2);
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  context.scale(scale, scale);
  return [canvas, context];
}

/** @param {CanvasRenderingContext2D} context @param {number} width @param {number} height @param {string} title */
function begin(context, width, height, title) {
  context.fillStyle = colour('page');
  context.fillRect(0, 0, width, height);
  context.fillStyle = colour('text');
  context.font = '13px system-ui, sans-serif';
  context.textAlign = 'left';
  context.textBaseline = 'top';
  context.fillText(title, MARGIN, MARGIN - 2, width - 2 * MARGIN);
}

/** The axes of the part of the slider that is seen in a frame whose upper left corner is given. @param {CanvasRenderingContext2D} context @param {number[]} corner */
function drawPlaces(context, corner) {
  const size = state.case?.block_size_m ?? 1;
  const [factor, letter] = prefix(Math.max(...camera.blocks) * size);
  const ends = [camera.toPixels([0, 0]), camera.toPixels(camera.blocks)];
  const seen = [0, 1].map((axis) => ends.map((end) => Math.min(Math.max(end[axis], 0), camera.pixels[axis])));
  const from = [corner[0] + seen[0][0], corner[1] + seen[1][0]];
  const [lowest, highest] = [0, 1].map((k) => camera.toBlocks([seen[0][k], seen[1][k]]).map((blocks) => (blocks * size) / factor));
  ['x', 'y'].forEach((name, axis) => {
    const length = Math.abs(seen[axis][1] - seen[axis][0]);
    drawAxis(context, { from, length, upright: axis === 1, range: [lowest[axis], highest[axis]], title: say('axis_place_of', { name, unit: `${letter}m` }) });
  });
}

/** What the colours beside the bar mean, as the legend of the page has it, up to a corner on the right. @param {CanvasRenderingContext2D} context @param {number[]} corner */
function drawEntries(context, [right, y]) {
  context.textBaseline = 'top';
  context.textAlign = 'right';
  let x = right;
  for (const swatch of [...find('legend').querySelectorAll('span:not([hidden]) > i')].reverse()) {
    const name = swatch.nextElementSibling?.textContent ?? '';
    context.fillStyle = colour('text');
    context.fillText(name, x, y);
    x -= context.measureText(name).width + 16;
    context.fillStyle = /** @type {HTMLElement} */ (swatch).style.background;
    context.fillRect(x, y, 11, 11);
    context.strokeRect(x, y, 11, 11);
    x -= 14;
  }
}

/** A canvas for the field, and what draws the field as it is into it. @param {number} scale @returns {[HTMLCanvasElement, (field: HTMLCanvasElement) => void]} */
export function fieldFigure(scale) {
  const [wide, high] = camera.pixels;
  const [x, y] = [MARGIN + SIDE, MARGIN + TITLE];
  const [width, height] = [x + wide + MARGIN, y + high + BELOW + BAR + MARGIN];
  const [canvas, context] = blank(width, height, scale);
  const draw = (/** @type {HTMLCanvasElement} */ field) => {
    const { numbers } = state;
    begin(context, width, height, say('figure_title', { name: state.case?.name ?? '', t: fixed(numbers?.t_star, 1), mu: fixed(numbers?.mu_star) }));
    context.imageSmoothingEnabled = false;
    const [left, top] = camera.toPixels([0, camera.blocks[1]]);
    context.save();
    context.beginPath();
    context.rect(x, y, wide, high);
    context.clip();
    context.drawImage(field, x + left, y + top, camera.blocks[0] * camera.scale, camera.blocks[1] * camera.scale);
    context.restore();
    const above = find('overlay');
    if (!above.hidden) context.drawImage(above, x + above.offsetLeft, y + above.offsetTop, above.offsetWidth, above.offsetHeight);
    drawPlaces(context, [x, y]);
    barInto(context, x, y + high + BELOW, wide);
    drawEntries(context, [x + wide, y + high + BELOW + BAR - 10]);
  };
  return [canvas, draw];
}

/** Names of the curves with a piece of each. @param {CanvasRenderingContext2D} context @param {number} y */
function legend(context, y) {
  let x = MARGIN;
  for (const { name, stroke, dash } of curveLines()) {
    context.strokeStyle = stroke;
    context.lineWidth = 2;
    context.setLineDash(dash);
    context.beginPath();
    context.moveTo(x, y + 7);
    context.lineTo(x + 28, y + 7);
    context.stroke();
    context.fillText(name, x + 34, y);
    x += 34 + context.measureText(name).width + 24;
  }
}

/** Hands over a picture of the curves, one below the other, with their legend. @param {(canvas: HTMLCanvasElement) => void} take */
export function curvesFigure(take) {
  const [wide, high] = CURVES;
  const [canvas, context] = blank(wide, high, SCALE);
  const [left, room] = [wide - 2 * MARGIN, high - 2 * MARGIN - 2 * TITLE];
  const heights = [0.6 * room, 0.4 * room];
  drawCurves(heights.map((height) => [left * SCALE, height * SCALE]), SCALE, (parts) => {
    begin(context, wide, high, say('figure_curves', { name: state.case?.name ?? '', percent: fixed(state.case?.texture_percent, 1) }));
    legend(context, MARGIN + TITLE);
    let y = MARGIN + 2 * TITLE;
    parts.forEach((part, k) => {
      context.drawImage(part, MARGIN, y, left, heights[k]);
      y += heights[k];
    });
    take(canvas);
  });
}

/** An axis with its numbers and title: below, or to the left if it is upright. @param {CanvasRenderingContext2D} context @param {{from: number[], length: number, upright: boolean, range: number[], title: string}} axis */
function drawAxis(context, { from: [x, y], length, upright, range: [low, high], title }) {
  context.save();
  context.font = '12px system-ui, sans-serif';
  context.textAlign = upright ? 'right' : 'center';
  context.textBaseline = upright ? 'middle' : 'top';
  for (const tick of ticks(low, high)) {
    const at = (high > low ? (tick - low) / (high - low) : 0) * length;
    if (upright) {
      context.fillRect(x - 4, Math.round(y - at), 4, 1);
      context.fillText(number(tick, 4), x - 7, y - at);
    } else {
      context.fillRect(Math.round(x + at), y, 1, 4);
      context.fillText(number(tick, 4), x + at, y + 6);
    }
  }
  context.textAlign = 'center';
  context.textBaseline = 'top';
  context.translate(...(upright ? /** @type {[number, number]} */ ([x - SIDE, y - length / 2]) : /** @type {[number, number]} */ ([x + length / 2, y + 20])));
  if (upright) context.rotate(-Math.PI / 2);
  context.fillText(title, 0, 0);
  context.restore();
}

/** The kymograph with its axes and its colour bar. */
export function kymographFigure() {
  const [wide, high] = [640, 320];
  const [left, top] = [MARGIN + SIDE, MARGIN + TITLE];
  const [width, height] = [left + wide + MARGIN, top + high + BELOW + BAR + MARGIN];
  const [canvas, context] = blank(width, height, SCALE);
  begin(context, width, height, say('figure_kymograph', { name: state.case?.name ?? '' }));
  context.imageSmoothingEnabled = false;
  context.drawImage(find('kymograph'), left, top, wide, high);
  const axes = kymographAxes();
  if (axes) {
    const from = [left, top + high];
    const [factor, letter] = prefix(Math.max(...axes.place.map(Math.abs)));
    drawAxis(context, { from, length: wide, upright: false, range: axes.place.map((metres) => metres / factor), title: say('axis_place', { unit: `${letter}m` }) });
    drawAxis(context, { from, length: high, upright: true, range: axes.time, title: say('axis_t') });
  }
  drawBar(context, { x: left, y: top + high + BELOW, width: wide, bytes: table(find('colourmap').value), low: 0, high: axes?.most ?? 100, unit: '%', title: say('kymograph_share') });
  return canvas;
}
