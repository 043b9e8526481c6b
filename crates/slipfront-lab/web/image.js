// @ts-check
// An image as texture: dropped on the page or chosen from a file. Dark is texture.
import { toBase64 } from './base64.js';
import { send } from './connection.js';
import { newGesture } from './edit.js';
import { find, onPress } from './element.js';
import { notice } from './notices.js';
import { state } from './store.js';
import { say } from './text.js';

const THRESHOLD = 0.5;

/**
 * The image as PNG, with no more pixels than the slider has blocks: each takes the pixel that is nearest to its middle, as a block does of
 * an image of any size.
 * @param {File} file
 */
async function asPng(file) {
  const picture = await createImageBitmap(file, { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
  const [nx, ny] = state.case?.blocks ?? [picture.width, picture.height];
  const canvas = new OffscreenCanvas(Math.min(picture.width, nx), Math.min(picture.height, ny));
  const context = /** @type {OffscreenCanvasRenderingContext2D} */ (canvas.getContext('2d'));
  context.imageSmoothingEnabled = false;
  context.drawImage(picture, 0, 0, canvas.width, canvas.height);
  return canvas.convertToBlob({ type: 'image/png' });
}

/** Takes an image as the texture. @param {File} file */
export async function takeImage(file) {
  try {
    const blob = await asPng(file);
    send({ do: 'image', png: toBase64(new Uint8Array(await blob.arrayBuffer())), threshold: THRESHOLD, gesture: newGesture() });
  } catch {
    notice(say('image_unreadable', { name: file.name }));
  }
}

/** Prepares the button. */
export function startImage() {
  onPress('tool-image', () => find('image-file').click());
  find('image-file').addEventListener('change', () => {
    const file = find('image-file').files?.[0];
    if (file) takeImage(file);
    find('image-file').value = '';
  });
}
