// @ts-check
// What is drawn above the field: outlines, handles, the brush, the cursor of the keyboard. Points are in blocks.
import { handles } from './shapes.js';
import { state } from './store.js';
import { colour } from './theme.js';

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
    if (selected && outlines.length > 0) drawHandles(context, camera, handles(state.case.texture[index], outlines[0]));
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

/**
 * Draws all of it. @param {CanvasRenderingContext2D} context @param {import('./camera.js').Camera} camera @param {number} ratio
 * @param {{ring: {point: number[], radius: number}|null, cursor: number[]|null}} pointers
 */
export function drawOverlay(context, camera, ratio, { ring, cursor }) {
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, camera.pixels[0], camera.pixels[1]);
  drawShapes(context, camera);
  if (ring) drawRing(context, camera, ring);
  if (cursor) drawCursor(context, camera, cursor);
}
