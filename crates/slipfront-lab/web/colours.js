// @ts-check
// The colour of every byte of a picture, and the colour bar that says what they mean.
import { COLOURMAPS } from './colourmaps.js';
import { LARGEST, NO_BLOCK, NOT_YET, SLIDES, TEXTURED } from './frames.js';
import { number, prefix, ticks } from './quantity.js';
import { colour } from './theme.js';

/** Red, green, blue of a colour as the browser computes it, `rgb(1, 2, 3)`. @param {string} text */
const rgb = (text) => (text.match(/\d+/g) ?? []).slice(0, 3).map(Number);

/** By how much blocks that hold are darker than their colour, so that those that slide are the brightest. */
const SHADE = 0.5;

/** @import { Field } from '../types/protocol' */

/** The colours of the bytes 0 to 255, four bytes each. @param {string} name of the colour map @param {Field} [field] */
export function table(name, field) {
  const isFront = field === 'front';
  const digits = COLOURMAPS[/** @type {keyof typeof COLOURMAPS} */ (name)];
  const bytes = new Uint8Array(4 * 256);
  for (let value = 0; value < 256; value++) {
    const at = 6 * Math.round((Math.min(value, LARGEST) / LARGEST) * 255);
    bytes.set([0, 2, 4].map((k) => parseInt(digits.slice(at + k, at + k + 2), 16) * (isFront ? SHADE : 1)), 4 * value);
    bytes[4 * value + 3] = 255;
  }
  for (const [value, what] of /** @type {Array<[number, string]>} */ ([[SLIDES, 'sliding'], [NOT_YET, isFront ? 'holds' : 'not-yet'], [NO_BLOCK, 'background'], [TEXTURED, 'textured']])) {
    bytes.set(rgb(colour(what)), 4 * value);
  }
  return bytes;
}

/**
 * Draws the colour bar with its numbers, unit and title into a rectangle of a canvas, 40 pixels high times the size of its letters.
 * @param {CanvasRenderingContext2D} context
 * @param {{x: number, y: number, width: number, bytes: Uint8Array, low: number, high: number, unit: string, title: string, scale?: number}} bar
 */
export function drawBar(context, { x, y, width, bytes, low, high, unit, title, scale = 1 }) {
  const [factor, letter] = unit === '' || unit === 't*' ? [1, ''] : prefix(Math.max(Math.abs(low), Math.abs(high)));
  const height = 12 * scale;
  const strip = new OffscreenCanvas(LARGEST + 1, 1);
  strip.getContext('2d')?.putImageData(new ImageData(new Uint8ClampedArray(bytes.subarray(0, 4 * (LARGEST + 1))), LARGEST + 1, 1), 0, 0);
  context.drawImage(strip, x, y, width, height);
  context.fillStyle = colour('text');
  context.strokeStyle = colour('text');
  context.font = `${12 * scale}px system-ui, sans-serif`;
  context.textBaseline = 'top';
  for (const tick of ticks(low / factor, high / factor)) {
    const at = high > low ? x + ((tick * factor - low) / (high - low)) * width : x;
    context.fillRect(Math.min(Math.round(at), x + width - 1), y + height, 1, 4 * scale);
    context.textAlign = at < x + height ? 'left' : at > x + width - height ? 'right' : 'center';
    context.fillText(number(tick, 4), at, y + height + 5 * scale);
  }
  context.textAlign = 'left';
  context.fillText(unit === '' ? title : `${title} (${letter}${unit})`, x, y + height + 19 * scale);
}
