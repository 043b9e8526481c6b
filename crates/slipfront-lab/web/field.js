// @ts-check
// The live field: takes pictures as they come, draws when there is something new and the browser is about to
// show it.
import { Camera } from './camera.js';
import { drawBar, table } from './colours.js';
import { atMost, find, make, onPress } from './element.js';
import { drawOverlay } from './overlay.js';
import { Picture } from './picture.js';
import { on, put, state } from './store.js';
import { say } from './text.js';
import { colour, enlargement, onTheme } from './theme.js';
import { setView } from './view.js';

/** @import { FieldPicture } from '../types/page' */
/** @import { CaseReply, Field } from '../types/protocol' */

/** The fields in the order of the choice: what slides comes first, and what few ask for last. @type {Field[]} */
const CHOICE = ['front', 'sliding', 'first_slip', 'traction', 'contact_stress', 'displacement', 'speed'];
const BAR_SPACING_MS = 250;
const BAR_HEIGHT = 46;
/** Pages on which the buttons of the zoom stand beside the field, and the room about them. */
const narrow = matchMedia('(max-width: 399px)');
const MARGIN = 8;

export const camera = new Camera();

/** What follows the pointer and the keyboard, and the corners of an outline that is not closed. @type {import('./overlay.js').Pointers} */
export const pointers = { ring: null, cursor: null, corners: [] };

/** @type {Picture} */
let picture;
/** The newest picture, and whether it was given to the graphics. @type {FieldPicture|null} */
let newest = null;
let taken = true;
let waiting = 0;
/** Whether what is above the field has changed: outlines of thousands of corners are not drawn with every picture. */
let above = true;
/** @type {Uint8Array} */
let colours = new Uint8Array(1024);
/** The field that they are for. @type {Field|null} */
let coloured = null;
/** @type {Array<(canvas: HTMLCanvasElement) => void>} */
const watchers = [];

/** Calls `action` with the canvas whenever the field has been drawn; the function that is returned ends that. @param {(canvas: HTMLCanvasElement) => void} action */
export function watchField(action) {
  watchers.push(action);
  return () => watchers.splice(watchers.indexOf(action), 1);
}

function redrawPicture() {
  if (!waiting) waiting = requestAnimationFrame(drawNow);
}

/** Draws the field and what is above it before the browser shows the page again. */
export function redraw() {
  above = true;
  redrawPicture();
}

/** Draws the field at once, as for a picture that is saved. */
export function drawNow() {
  cancelAnimationFrame(waiting);
  waiting = 0;
  if (newest && !taken) picture.take(newest);
  taken = true;
  picture.draw();
  if (above) {
    picture.place(camera);
    drawOverlay(find('overlay'), camera, devicePixelRatio, pointers);
  }
  above = false;
  for (const action of watchers) action(picture.canvas);
}

/** The colour bar of the newest picture, drawn at (x, y). @param {CanvasRenderingContext2D} context @param {number} x @param {number} y @param {number} width @param {number} [scale] */
export function barInto(context, x, y, width, scale) {
  if (!newest) return;
  const { low, high, unit, field } = newest;
  drawBar(context, { x, y, width, bytes: colours, low, high, unit, title: say(`field_${field === 'front' ? 'first_slip' : field}`), scale });
}

function drawBarOfPage() {
  const canvas = find('bar');
  const [ratio, width] = [devicePixelRatio, canvas.clientWidth];
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(BAR_HEIGHT * enlargement() * ratio);
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  barInto(context, 1, 0, width - 2, enlargement());
}
const refreshBar = atMost(drawBarOfPage, BAR_SPACING_MS);

function recolour() {
  coloured = state.view.field;
  colours = table(find('colourmap').value, coloured);
  picture.colour(colours);
  for (const [id, name] of [['textured', 'textured'], ['sliding', 'sliding'], ['not-yet', coloured === 'front' ? 'holds' : 'not-yet']]) {
    find(`legend-${id}`).style.background = colour(name);
  }
  refreshBar();
  redraw();
}

function fitCanvas() {
  const frame = find('frame');
  // Beside buttons that would cover a good part of a narrow field.
  const beside = narrow.matches ? find('zoom').offsetWidth : 0;
  camera.pixels = [frame.clientWidth - (beside > 0 ? beside + MARGIN : 0), frame.clientHeight];
  refreshBar();
  redraw();
}

/** @param {FieldPicture} came */
function take(came) {
  const changed = !newest || came.field !== newest.field || came.low !== newest.low || came.high !== newest.high;
  newest = came;
  taken = false;
  if (changed) refreshBar();
  redrawPicture();
}

/** @param {CaseReply} shown */
function showCase({ blocks }) {
  const same = camera.blocks[0] === blocks[0] && camera.blocks[1] === blocks[1];
  if (!same) camera.reset(blocks);
  redraw();
}

function showLegend() {
  const entry = (/** @type {string} */ id) => /** @type {HTMLElement} */ (find(id).parentElement);
  entry('legend-sliding').hidden = state.view.field !== 'front';
  entry('legend-not-yet').hidden = !['first_slip', 'front'].includes(state.view.field);
  if (coloured !== state.view.field) recolour();
  if (find('field').value !== state.view.field) find('field').value = state.view.field;
}

/** Prepares the field and its choices. */
export function startField() {
  picture = new Picture(find('canvas'));
  if (!picture.gl) put('problem', { key: 'no_webgl' });
  picture.canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
  picture.canvas.addEventListener('webglcontextrestored', () => {
    if (picture.gl) picture.prepare(picture.gl);
    taken = false;
    recolour();
  });
  find('field').append(...CHOICE.map((field) => make('option', { value: field, textContent: say(`field_${field}`) })));
  find('colourmap').append(...['viridis', 'cividis'].map((name) => make('option', { value: name, textContent: say(`colourmap_${name}`) })));
  find('field').addEventListener('change', () => setView({ field: /** @type {Field} */ (find('field').value) }));
  find('colourmap').addEventListener('change', recolour);
  for (const [id, factor] of /** @type {Array<[string, number]>} */ ([['zoom-in', 1.5], ['zoom-out', 1 / 1.5]])) {
    onPress(id, () => {
      camera.enlarge(factor);
      redraw();
    });
  }
  onPress('zoom-all', () => {
    camera.reset();
    redraw();
  });
  new ResizeObserver(fitCanvas).observe(find('frame'));
  on('picture', take);
  on('case', showCase);
  on('selected', redraw);
  on('view', showLegend);
  onTheme(recolour);
  showLegend();
}
