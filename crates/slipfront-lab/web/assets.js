// @ts-check
// The files of the page: beside it, or within it where the page is one file.
import { fromBase64 } from './base64.js';

/** Whether there is no server: the session runs in a Worker of the page. */
export const isAlone = document.documentElement.dataset.channel === 'worker';

/** The files within the page, text or compressed in Base64, by their names; none where they stand beside it. @type {Record<string, string>|null} */
const inside = JSON.parse(document.getElementById('files')?.textContent ?? 'null');

/** Whether the page is one file. */
export const isSingle = inside !== null;

/** The text of a file; null if there is none of this name. @param {string} name @returns {Promise<string|null>} */
export async function textOf(name) {
  if (inside) return inside[name] ?? null;
  const answer = await fetch(name);
  return answer.ok ? answer.text() : null;
}

/** A file of JSON. @param {string} name */
export const jsonOf = async (name) => JSON.parse((await textOf(name)) ?? 'null');

/** The bytes of a file; null if there is none of this name. @param {string} name @returns {Promise<ArrayBuffer|null>} */
export async function bytesOf(name) {
  if (inside) {
    if (!(name in inside)) return null;
    const compressed = new Blob([fromBase64(inside[name])]).stream();
    return new Response(compressed.pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
  }
  const answer = await fetch(name);
  return answer.ok ? answer.arrayBuffer() : null;
}
