// @ts-check
// A case as part of an address: base64url of the deflated JSON {"name", "toml", "files"}.
import { fromBase64, toBase64 } from './base64.js';

/** A longer address is cut by some mail programs and chats. */
const MAX_LENGTH = 16384;

/** A link can be unpacked to a thousand times its length; the server takes messages of 8 MiB. */
const MAX_UNPACKED = 7 << 20;

/** @param {Uint8Array} bytes @param {CompressionStream|DecompressionStream} stream */
async function through(bytes, stream) {
  const body = new Blob([/** @type {BlobPart} */ (bytes)]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(body).arrayBuffer());
}

/** The link of a case, or null if it would be too long. @param {{name?: string, toml: string, files: Record<string, string>}} content */
export async function makeLink(content) {
  const json = new TextEncoder().encode(JSON.stringify(content));
  const packed = await through(json, new CompressionStream('deflate-raw'));
  const text = toBase64(packed).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
  return text.length > MAX_LENGTH ? null : text;
}

/** A value that is a text. @param {unknown} value @returns {string} */
function text(value) {
  if (typeof value !== 'string') throw new TypeError('not a text');
  return value;
}

/** The case of a link; throws if it is none. @param {string} link @returns {Promise<{name?: string, toml: string, files: Record<string, string>}>} */
export async function readLink(link) {
  if (link.length > MAX_LENGTH) throw new RangeError('too long');
  const packed = fromBase64(link.replaceAll('-', '+').replaceAll('_', '/'));
  const json = await through(packed, new DecompressionStream('deflate-raw'));
  if (json.length > MAX_UNPACKED) throw new RangeError('too much');
  const { name, toml, files } = JSON.parse(new TextDecoder().decode(json));
  const contents = Object.entries(files ?? {}).map(([file, content]) => [file, text(content)]);
  return { name: name === undefined ? name : text(name), toml: text(toml), files: Object.fromEntries(contents) };
}
