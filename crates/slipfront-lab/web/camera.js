// @ts-check
// Which part of the slider the field shows: a block is `scale` pixels wide, and the block coordinates `x`,
// `y` are in the middle.

const MAX_ZOOM = 64;

/** @param {number} value @param {number} low @param {number} high */
const within = (value, low, high) => Math.min(Math.max(value, low), high);

export class Camera {
  blocks = [1, 1];
  pixels = [1, 1];
  zoom = 1;
  x = 0.5;
  y = 0.5;

  /** Pixels per block when all of the slider is seen. */
  get fit() {
    return Math.min(this.pixels[0] / this.blocks[0], this.pixels[1] / this.blocks[1]);
  }

  get scale() {
    return this.fit * this.zoom;
  }

  /** Shows all of a slider of this many blocks. @param {number[]} blocks */
  reset(blocks = this.blocks) {
    this.blocks = blocks;
    this.zoom = 1;
    this.x = blocks[0] / 2;
    this.y = blocks[1] / 2;
  }

  /** The pixel (x right, y down) of a point in blocks. @param {number[]} point */
  toPixels([x, y]) {
    return [this.pixels[0] / 2 + (x - this.x) * this.scale, this.pixels[1] / 2 - (y - this.y) * this.scale];
  }

  /** The point in blocks of a pixel. @param {number[]} pixel */
  toBlocks([x, y]) {
    return [this.x + (x - this.pixels[0] / 2) / this.scale, this.y - (y - this.pixels[1] / 2) / this.scale];
  }

  /** Moves the picture by this many pixels. @param {number} dx @param {number} dy */
  pan(dx, dy) {
    this.x = within(this.x - dx / this.scale, 0, this.blocks[0]);
    this.y = within(this.y + dy / this.scale, 0, this.blocks[1]);
  }

  /** Enlarges by `factor`; the point below `pixel` stays where it is. @param {number} factor @param {number[]} [pixel] */
  enlarge(factor, pixel = [this.pixels[0] / 2, this.pixels[1] / 2]) {
    const before = this.toBlocks(pixel);
    this.zoom = within(this.zoom * factor, 1, MAX_ZOOM);
    const after = this.toBlocks(pixel);
    this.x = within(this.x + before[0] - after[0], 0, this.blocks[0]);
    this.y = within(this.y + before[1] - after[1], 0, this.blocks[1]);
    if (this.zoom === 1) this.reset();
  }
}
