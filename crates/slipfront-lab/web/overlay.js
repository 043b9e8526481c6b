// @ts-check
// What is drawn above the field: outlines, handles, the brush, the cursor of the keyboard. Points are in
// blocks.
import { handles } from './shapes.js';
import { presentCase, state } from './store.js';
import { colour } from './theme.js';

/** @typedef {{ring: {point: number[], radius: number}|null, cursor: number[]|null, corners: number[][]}} Pointers */

/** Pixels around what is drawn: half a cursor and the width of lines. */
const MARGIN = 12;

/** @param {CanvasRenderingContext2D} context @param {import('./camera.js').Camera} camera @param {number[][]} outline */
function trace(context, camera, outline) {
  outline.forEach((point, k) => {
    const [x, y] = camera.toPixels(point);
    if (k === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  });
  context.closePath();
}

/** A line that is seen on dark and on bright blocks. @param {CanvasRenderingContext2D} context @param {number} width */
function strokeTwice(context, width) {
  context.lineWidth = width + 2;
  context.strokeStyle = 'rgba(0, 0, 0, 0.6)';
  context.stroke();
  context.lineWidth = width;
  context.strokeStyle = 'white';
  context.stroke();
}

/** @param {CanvasRenderingContext2D} context @param {import('./camera.js').Camera} camera */
function drawShapes(context, camera) {
  for (const { index, outlines } of state.case?.shapes ?? []) {
    const selected = index === state.selected;
    context.beginPath();
    for (const outline of outlines) trace(context, camera, outline);
    if (selected) strokeTwice(context, 2);
    else {
      context.lineWidth = 1;
      context.strokeStyle = colour('outline');
      context.stroke();
    }
    if (selected && outlines.length > 0) drawHandles(context, camera, handles(presentCase().texture[index], outlines[0]));
  }
}

/** @param {CanvasRenderingContext2D} context @param {import('./camera.js').Camera} camera @param {number[][]} points */
function drawHandles(context, camera, points) {
  for (const point of points) {
    const [x, y] = camera.toPixels(point);
    context.beginPath();
    context.rect(x - 4, y - 4, 8, 8);
    context.fillStyle = 'white';
    context.fill();
    context.lineWidth = 1.5;
    context.strokeStyle = 'black';
    context.stroke();
  }
}

/** @param {CanvasRenderingContext2D} context @param {import('./camera.js').Camera} camera @param {{point: number[], radius: number}} ring */
function drawRing(context, camera, { point, radius }) {
  const [x, y] = camera.toPixels(point);
  context.beginPath();
  context.arc(x, y, radius * camera.scale, 0, 2 * Math.PI);
  strokeTwice(context, 1);
}

/** @param {CanvasRenderingContext2D} context @param {import('./camera.js').Camera} camera @param {number[]} point */
function drawCursor(context, camera, point) {
  const [x, y] = camera.toPixels(point);
  context.beginPath();
  context.moveTo(x - 10, y);
  context.lineTo(x + 10, y);
  context.moveTo(x, y - 10);
  context.lineTo(x, y + 10);
  strokeTwice(context, 1.5);
}

/** An outline that is not closed. @param {CanvasRenderingContext2D} context @param {import('./camera.js').Camera} camera @param {number[][]} corners */
function drawCorners(context, camera, corners) {
  if (corners.length === 0) return;
  context.beginPath();
  for (const [x, y] of corners.map((corner) => camera.toPixels(corner))) context.lineTo(x, y);
  strokeTwice(context, 2);
  drawHandles(context, camera, corners);
}

/** The best texture of a search that is under way. @param {CanvasRenderingContext2D} context @param {import('./camera.js').Camera} camera */
function drawFinding(context, camera) {
  context.fillStyle = colour('finding');
  for (const [row, from, to] of state.finding?.best_texture ?? []) {
    // On whole pixels, since strips that share one show a line between them.
    const [left, top] = camera.toPixels([from, row + 1]).map(Math.round);
    const [right, bottom] = camera.toPixels([to, row]).map(Math.round);
    context.fillRect(left, top, right - left, bottom - top);
  }
}

/** The part of the frame that is drawn on, [left, top, right, bottom] in pixels. @param {import('./camera.js').Camera} camera @param {Pointers} pointers */
function extent(camera, { ring, cursor, corners }) {
  const points = (state.case?.shapes ?? []).flatMap((shape) => shape.outlines.flat()).map((point) => camera.toPixels(point));
  points.push(...(state.finding?.best_texture ?? []).flatMap(([row, from, to]) => [camera.toPixels([from, row]), camera.toPixels([to, row + 1])]));
  points.push(...corners.map((corner) => camera.toPixels(corner)));
  if (cursor) points.push(camera.toPixels(cursor));
  if (ring) {
    const [x, y] = camera.toPixels(ring.point);
    const reach = ring.radius * camera.scale;
    points.push([x - reach, y - reach], [x + reach, y + reach]);
  }
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (const [x, y] of points) {
    box[0] = Math.min(box[0], x);
    box[1] = Math.min(box[1], y);
    box[2] = Math.max(box[2], x);
    box[3] = Math.max(box[3], y);
  }
  return box.map((value, side) => Math.min(Math.max(Math.round(value + (side < 2 ? -MARGIN : MARGIN)), 0), camera.pixels[side % 2]));
}

/**
 * Draws all of it on a canvas as large as what is drawn: what lies above the field costs with every picture.
 * @param {HTMLCanvasElement} canvas @param {import('./camera.js').Camera} camera @param {number} ratio @param {Pointers} pointers
 */
export function drawOverlay(canvas, camera, ratio, pointers) {
  const [left, top, right, bottom] = extent(camera, pointers);
  canvas.hidden = right <= left || bottom <= top;
  if (canvas.hidden) return;
  Object.assign(canvas.style, { left: `${left}px`, top: `${top}px`, width: `${right - left}px`, height: `${bottom - top}px` });
  canvas.width = Math.round((right - left) * ratio);
  canvas.height = Math.round((bottom - top) * ratio);
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  context.setTransform(ratio, 0, 0, ratio, -left * ratio, -top * ratio);
  drawFinding(context, camera);
  drawShapes(context, camera);
  drawCorners(context, camera, pointers.corners);
  if (pointers.ring) drawRing(context, camera, pointers.ring);
  if (pointers.cursor) drawCursor(context, camera, pointers.cursor);
}
