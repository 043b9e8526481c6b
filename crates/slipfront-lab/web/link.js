// @ts-check
// A case as part of an address: base64url of the deflated JSON {"name", "toml", "files"}.

/** A longer address is cut by some mail programs and chats. */
const MAX_LENGTH = 16384;

/** @param {Uint8Array} bytes @param {CompressionStream|DecompressionStream} stream */
async function through(bytes, stream) {
  const body = new Blob([/** @type {BlobPart} */ (bytes)]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(body).arrayBuffer());
}

/** Bytes as base64. @param {Uint8Array} bytes */
export function toBase64(bytes) {
  let text = '';
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text);
}

/** @param {string} text @returns {Uint8Array<ArrayBuffer>} */
export const fromBase64 = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

/** The link of a case, or null if it would be too long. @param {{name?: string, toml: string, files: Record<string, string>}} content */
export async function makeLink(content) {
  const json = new TextEncoder().encode(JSON.stringify(content));
  const packed = await through(json, new CompressionStream('deflate-raw'));
  const text = toBase64(packed).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
  return text.length > MAX_LENGTH ? null : text;
}

/** The case of a link; throws if it is none. @param {string} text @returns {Promise<{name?: string, toml: string, files: Record<string, string>}>} */
export async function readLink(text) {
  const packed = fromBase64(text.replaceAll('-', '+').replaceAll('_', '/'));
  const { name, toml, files } = JSON.parse(new TextDecoder().decode(await through(packed, new DecompressionStream('deflate-raw'))));
  if (typeof toml !== 'string') throw new TypeError('toml');
  return { name, toml, files: files ?? {} };
}
