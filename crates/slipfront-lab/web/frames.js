// @ts-check
// The binary messages of the server, little endian.

/** @import { FieldPicture, KymographPicture } from '../types/page' */
/** @import { Field } from '../types/protocol' */

/** The fields in the order of their numbers. @type {Field[]} */
export const FIELDS = ['contact_stress', 'traction', 'displacement', 'speed', 'sliding', 'first_slip', 'front'];
export const UNITS = ['Pa', 'Pa', 'm', 'm/s', '', 't*', 't*'];
/** Bytes of a picture that are no value. */
export const SLIDES = 252;
export const NOT_YET = 253;
export const NO_BLOCK = 254;
export const TEXTURED = 255;
/** The byte of the largest value. */
export const LARGEST = 250;

/** A picture of the field. @param {DataView} view @returns {FieldPicture} */
function picture(view) {
  const field = view.getUint8(1);
  const [nx, ny] = [view.getUint16(32, true), view.getUint16(34, true)];
  return {
    field: FIELDS[field],
    unit: UNITS[field],
    recorded: (view.getUint16(2, true) & 1) === 1,
    number: view.getUint32(4, true),
    step: view.getUint32(8, true),
    tStar: view.getFloat32(12, true),
    muStar: view.getFloat32(16, true),
    slidingPercent: view.getFloat32(20, true),
    low: view.getFloat32(24, true),
    high: view.getFloat32(28, true),
    nx,
    ny,
    bytes: new Uint8Array(view.buffer, 36, nx * ny),
  };
}

/** What slides where and when. @param {DataView} view @returns {KymographPicture} */
function kymograph(view) {
  const [rows, bins] = [view.getUint32(4, true), view.getUint32(8, true)];
  return {
    rows,
    bins,
    firstStar: view.getFloat32(12, true),
    lastStar: view.getFloat32(16, true),
    edgeBlocks: view.getFloat32(20, true),
    binBlocks: view.getFloat32(24, true),
    bytes: new Uint8Array(view.buffer, 28, rows * bins),
  };
}

/** The topic and the value of a binary message. @param {ArrayBuffer} buffer @returns {['picture', FieldPicture]|['kymograph', KymographPicture]} */
export function parse(buffer) {
  const view = new DataView(buffer);
  return view.getUint8(0) === 1 ? ['picture', picture(view)] : ['kymograph', kymograph(view)];
}
