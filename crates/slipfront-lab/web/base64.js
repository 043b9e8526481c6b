// @ts-check
// Bytes as text, and back.

/** Bytes that become text at once: a call has no room for more than some ten thousand values. */
const PIECE = 0x2000;

/** Bytes as base64. @param {Uint8Array} bytes */
export function toBase64(bytes) {
  let text = '';
  for (let k = 0; k < bytes.length; k += PIECE) text += String.fromCharCode(...bytes.subarray(k, k + PIECE));
  return btoa(text);
}

/** The bytes of base64. @param {string} text */
export function fromBase64(text) {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let k = 0; k < bytes.length; k += 1) bytes[k] = letters.charCodeAt(k);
  return bytes;
}
