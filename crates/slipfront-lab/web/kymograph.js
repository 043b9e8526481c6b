// @ts-check
// What slides where along the drive (to the right) and when (upwards), as the command draws it.
import { table } from './colours.js';
import { atMost, find } from './element.js';
import { LARGEST } from './frames.js';
import { number, quantity } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';
import { onTheme } from './theme.js';

/** @import { KymographPicture } from '../types/page' */

const SPACING_MS = 500;

/** @type {KymographPicture|null} */
let newest = null;

/** The largest share of sliding blocks, as a byte, so that colours go up to it. @param {Uint8Array} bytes */
const largest = (bytes) => bytes.reduce((most, value) => (value <= LARGEST ? Math.max(most, value) : most), 1);

function draw() {
  if (!newest || newest.rows === 0 || newest.bins === 0) return;
  const { rows, bins, bytes, firstStar, lastStar, edgeBlocks, binBlocks } = newest;
  const canvas = find('kymograph');
  canvas.width = bins;
  canvas.height = rows;
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  const image = context.createImageData(bins, rows);
  const pixels = new Uint32Array(image.data.buffer);
  const colours = new Uint32Array(table(find('colourmap').value).buffer);
  const most = largest(bytes);
  bytes.forEach((value, k) => {
    const row = rows - 1 - Math.floor(k / bins);
    pixels[row * bins + (k % bins)] = colours[value <= LARGEST ? Math.round((value * LARGEST) / most) : value];
  });
  context.putImageData(image, 0, 0);
  const place = (/** @type {number} */ blocks) => quantity(blocks * (state.case?.block_size_m ?? 1), 'm');
  find('kymograph-low').textContent = say('kymograph_t', { t: number(firstStar) });
  find('kymograph-high').textContent = say('kymograph_t', { t: number(lastStar) });
  find('kymograph-first').textContent = place(edgeBlocks);
  find('kymograph-last').textContent = place(edgeBlocks + bins * binBlocks);
  find('kymograph-note').textContent = say('kymograph_note', { most: number((100 * most) / LARGEST, 2) });
}
const refresh = atMost(draw, SPACING_MS);

/** What the axes of the newest kymograph go over, t* and metres, and its largest share, %; null if there is none. */
export function kymographAxes() {
  if (!newest || newest.rows === 0 || newest.bins === 0) return null;
  const { bins, bytes, firstStar, lastStar, edgeBlocks, binBlocks } = newest;
  const size = state.case?.block_size_m ?? 1;
  return { time: [firstStar, lastStar], place: [edgeBlocks * size, (edgeBlocks + bins * binBlocks) * size], most: (100 * largest(bytes)) / LARGEST };
}

/** Begins to listen. */
export function startKymograph() {
  on('kymograph', (came) => {
    newest = came;
    refresh();
  });
  find('colourmap').addEventListener('change', draw);
  onTheme(draw);
}
