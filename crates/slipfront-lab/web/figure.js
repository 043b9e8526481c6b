// @ts-check
// Panels as pictures: the field with its title and colour bar, the curves, the kymograph.
import { barInto, camera } from './field.js';
import { curveCanvases } from './curves.js';
import { find } from './element.js';
import { fixed } from './quantity.js';
import { state } from './store.js';
import { say } from './text.js';
import { colour } from './theme.js';

const MARGIN = 12;
const TITLE = 24;
const BAR = 40;

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

/** A canvas for the field, and what draws the field as it is into it. @param {number} scale @returns {[HTMLCanvasElement, (field: HTMLCanvasElement) => void]} */
export function fieldFigure(scale) {
  const [wide, high] = camera.pixels;
  const [width, height] = [wide + 2 * MARGIN, high + 2 * MARGIN + TITLE + BAR];
  const [canvas, context] = blank(width, height, scale);
  const draw = (/** @type {HTMLCanvasElement} */ field) => {
    const { numbers } = state;
    begin(context, width, height, say('figure_title', { name: state.case?.name ?? '', t: fixed(numbers?.t_star, 1), mu: fixed(numbers?.mu_star) }));
    context.imageSmoothingEnabled = false;
    const [left, top] = camera.toPixels([0, camera.blocks[1]]);
    context.save();
    context.beginPath();
    context.rect(MARGIN, MARGIN + TITLE, wide, high);
    context.clip();
    context.drawImage(field, MARGIN + left, MARGIN + TITLE + top, camera.blocks[0] * camera.scale, camera.blocks[1] * camera.scale);
    context.restore();
    const above = find('overlay');
    if (!above.hidden) context.drawImage(above, MARGIN + above.offsetLeft, MARGIN + TITLE + above.offsetTop, above.offsetWidth, above.offsetHeight);
    barInto(context, MARGIN, MARGIN + TITLE + high + 6, wide);
  };
  return [canvas, draw];
}

/** The curves below each other. */
export function curvesFigure() {
  const parts = curveCanvases();
  const ratio = devicePixelRatio;
  const width = Math.max(...parts.map((part) => part.width)) / ratio;
  const height = parts.reduce((sum, part) => sum + part.height / ratio, 0);
  const [canvas, context] = blank(width + 2 * MARGIN, height + 2 * MARGIN + TITLE, ratio);
  begin(context, width + 2 * MARGIN, height + 2 * MARGIN + TITLE, state.case?.name ?? '');
  let y = MARGIN + TITLE;
  for (const part of parts) {
    context.drawImage(part, MARGIN, y, part.width / ratio, part.height / ratio);
    y += part.height / ratio;
  }
  return canvas;
}

/** The kymograph with its axes. */
export function kymographFigure() {
  const [wide, high] = [600, 240];
  const [width, height] = [wide + 2 * MARGIN, high + 2 * MARGIN + TITLE + BAR];
  const [canvas, context] = blank(width, height, 2);
  const text = (/** @type {string} */ id) => find(id).textContent;
  begin(context, width, height, say('figure_kymograph', { name: state.case?.name ?? '', low: text('kymograph-low'), high: text('kymograph-high') }));
  context.imageSmoothingEnabled = false;
  context.drawImage(find('kymograph'), MARGIN, MARGIN + TITLE, wide, high);
  context.fillText(text('kymograph-first'), MARGIN, MARGIN + TITLE + high + 6);
  context.textAlign = 'right';
  context.fillText(text('kymograph-last'), MARGIN + wide, MARGIN + TITLE + high + 6);
  return canvas;
}
