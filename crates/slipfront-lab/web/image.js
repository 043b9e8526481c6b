// @ts-check
// An image as texture: dropped on the page or chosen from a file. Dark is texture.
import { send } from './connection.js';
import { newGesture } from './edit.js';
import { find, onPress } from './element.js';
import { toBase64 } from './link.js';
import { notice } from './notices.js';
import { say } from './text.js';

/** The server takes messages of 8 MiB, and base64 makes a third more of an image. */
const MAX_BYTES = 5 * 1024 * 1024;
const THRESHOLD = 0.5;

/** The file as PNG; other images are drawn and written as one. @param {File} file */
async function asPng(file) {
  if (file.type === 'image/png') return file;
  const picture = await createImageBitmap(file);
  const canvas = new OffscreenCanvas(picture.width, picture.height);
  canvas.getContext('2d')?.drawImage(picture, 0, 0);
  return canvas.convertToBlob({ type: 'image/png' });
}

/** @param {File} file */
async function take(file) {
  try {
    const blob = await asPng(file);
    if (blob.size > MAX_BYTES) return notice(say('image_too_large', { size: (blob.size / 2 ** 20).toFixed(1), most: MAX_BYTES / 2 ** 20 }));
    send({ do: 'image', png: toBase64(new Uint8Array(await blob.arrayBuffer())), threshold: THRESHOLD, gesture: newGesture() });
  } catch {
    notice(say('image_unreadable', { name: file.name }));
  }
}

/** Prepares the button and the drop. */
export function startImage() {
  onPress('tool-image', () => find('image-file').click());
  find('image-file').addEventListener('change', () => {
    const file = find('image-file').files?.[0];
    if (file) take(file);
    find('image-file').value = '';
  });
  document.addEventListener('dragover', (event) => event.preventDefault());
  document.addEventListener('drop', (event) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (file) take(file);
  });
}
