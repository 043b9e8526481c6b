// @ts-check
// `[[texture]]` tables as the case file has them (docs/reference/case-file.md): made, moved, sized and
// turned. Nothing is changed in place.
import { length, metres } from './quantity.js';

/** @import { CaseReply, Texture } from '../types/protocol' */
/** @typedef {{blocks: number[], blockSize: number, count: number}} Slider blocks along x and y, their edge in metres, how many exist */
/** @typedef {{s: number, w: number, columns: number, rows: number, orientation: string}} Options of new shapes */

/** The slider of a case. @param {CaseReply} shown @returns {Slider} */
export const sliderOf = ({ blocks, block_size_m: blockSize, n_blocks: count }) => ({ blocks, blockSize, count });

const MAX_COVERAGE = 99;

/** What a table is called: the key of its name in en.json is `shape_` and this. @param {Texture} table */
export function kind(table) {
  if (table.shape !== 'cavity') return table.shape === 'polygon' ? 'outline' : table.shape;
  if ((table.s ?? 1) > 1) return 'polygon';
  const single = (table.w ?? 0) === 0 ? 'circle' : 'ellipse';
  const copies = Array.isArray(table.array) ? table.array : [];
  return table.pitch || copies.some((count) => count > 1) ? 'array' : single;
}

/** The middle of the slider in metres. @param {Slider} slider */
const middle = ({ blocks, blockSize }) => blocks.map((count) => (count / 2) * blockSize);

/** Where a cavity stands, in metres. @param {Texture} table @param {Slider} slider */
export function center(table, slider) {
  if (!Array.isArray(table.center)) return middle(slider);
  return table.center.map((text) => metres(text) ?? 0);
}

/** @param {number[]} point in metres */
const pair = (point) => point.map(length);

/** Percent of the slider in a cavity of length lambda, Eq. 18: pi lambda^2 (1 - s w^2) over the area of all blocks. @param {number} lambda m @param {{s?: number, w?: number}} table @param {Slider} slider */
export function coverageOf(lambda, { s = 1, w = 0 }, { count, blockSize }) {
  return (100 * Math.PI * lambda ** 2 * (1 - s * w ** 2)) / (count * blockSize ** 2);
}

/** @param {number} value percent */
const coverage = (value) => Number(Math.min(Math.max(value, 0.01), MAX_COVERAGE).toPrecision(4));

/**
 * A new shape around a point, of the size that a drag of `radius` blocks means, or of its ordinary size without a drag.
 * @param {string} tool @param {Options} options @param {number[]} point in blocks @param {number} radius in blocks @param {Slider} slider
 * @returns {Texture}
 */
export function create(tool, options, point, radius, slider) {
  const at = point.map((value) => value * slider.blockSize);
  if (tool === 'groove') {
    const axis = options.orientation === 'along' ? 1 : 0;
    const share = radius > 0 ? (200 * radius) / slider.blocks[axis] : 10;
    return { shape: 'groove', orientation: options.orientation, coverage: coverage(share), offset: length(at[axis] - middle(slider)[axis]) };
  }
  /** @type {Texture} */
  const table = { shape: 'cavity', center: pair(at) };
  if (tool === 'ellipse') table.w = options.w;
  if (tool === 'polygon') Object.assign(table, { s: options.s, w: options.w });
  if (tool === 'array') table.array = [options.columns, options.rows];
  const copies = tool === 'array' ? options.columns * options.rows : 1;
  const single = radius > 0 ? coverageOf(radius * slider.blockSize, table, slider) : 0;
  table.coverage = coverage(radius > 0 ? single * copies : tool === 'array' ? 10 : 5);
  return table;
}

/** A shape with these corners, in blocks. @param {number[][]} corners @param {Slider} slider @returns {Texture} */
export const outline = (corners, { blockSize }) => ({ shape: 'polygon', points: corners.map((corner) => pair(corner.map((value) => value * blockSize))) });

/** The shape moved by (dx, dy) blocks. @param {Texture} table @param {number[]} by @param {Slider} slider @returns {Texture} */
export function move(table, by, slider) {
  const [dx, dy] = by.map((value) => value * slider.blockSize);
  if (table.shape === 'cavity') {
    const [x, y] = center(table, slider);
    return { ...table, center: pair([x + dx, y + dy]) };
  }
  if (table.shape === 'groove') {
    const along = table.orientation === 'along';
    return { ...table, offset: length((metres(table.offset) ?? 0) + (along ? dy : dx)) };
  }
  if (table.shape === 'polygon') {
    return { ...table, points: table.points?.map(([x, y]) => pair([(metres(x) ?? 0) + dx, (metres(y) ?? 0) + dy])) };
  }
  return table;
}

/** The shape made larger by `factor` around its middle. @param {Texture} table @param {number} factor @returns {Texture} */
export function enlarge(table, factor) {
  if (table.points) {
    const points = table.points.map((point) => point.map((text) => metres(text) ?? 0));
    const heart = [0, 1].map((axis) => points.reduce((sum, point) => sum + point[axis], 0) / points.length);
    return { ...table, points: points.map((point) => pair(point.map((value, axis) => heart[axis] + factor * (value - heart[axis])))) };
  }
  if (table.coverage !== undefined) return { ...table, coverage: coverage(table.coverage * (table.shape === 'groove' ? factor : factor ** 2)) };
  for (const key of /** @type {['lambda', 'width']} */ (['lambda', 'width'])) {
    if (table[key] !== undefined) return { ...table, [key]: length((metres(table[key]) ?? 0) * factor) };
  }
  return table;
}

/** A cavity turned by so many degrees more, from x towards y. @param {Texture} table @param {number} degrees @returns {Texture} */
export function turn(table, degrees) {
  if (table.shape !== 'cavity') return table;
  const angle = ((((table.rotate ?? 0) + degrees + 180) % 360) + 360) % 360 - 180;
  return { ...table, rotate: Number(angle.toFixed(3)) };
}

/** Whether a point lies inside outlines, by the even-odd rule. @param {number[][][]} outlines @param {number[]} point */
export function inside(outlines, [x, y]) {
  let odd = false;
  for (const outline of outlines) {
    outline.forEach(([x1, y1], k) => {
      const [x2, y2] = outline[(k + 1) % outline.length];
      if (y1 > y !== y2 > y && x < x1 + ((y - y1) / (y2 - y1)) * (x2 - x1)) odd = !odd;
    });
  }
  return odd;
}

/** The box around an outline: [left, bottom, right, top]. @param {number[][]} outline */
export function box(outline) {
  const [xs, ys] = [0, 1].map((axis) => outline.map((point) => point[axis]));
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

/** Where a shape is gripped to size it, in blocks: the sides of a groove, the corners of the box around another. @param {Texture} table @param {number[][]} outline */
export function handles(table, outline) {
  const [left, bottom, right, top] = box(outline);
  const [x, y] = [(left + right) / 2, (bottom + top) / 2];
  if (table.shape === 'groove') return table.orientation === 'along' ? [[x, bottom], [x, top]] : [[left, y], [right, y]];
  return [[left, bottom], [right, bottom], [right, top], [left, top]];
}
