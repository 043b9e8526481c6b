// @ts-check
// The simulation as WebAssembly, of a page without a server: index.html begins with this script, so that it
// is loaded and compiled while all others are.
import { bytesOf, isAlone, textOf } from './assets.js';

/** A module without a function, of which one instruction is of SIMD. */
const SIMD = Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11);

/** A compiled module; null where it is missing or damaged. @param {string} name @returns {Promise<WebAssembly.Module|null>} */
async function compiled(name) {
  try {
    const bytes = await bytesOf(name);
    return bytes && (await WebAssembly.compile(bytes));
  } catch {
    return null;
  }
}

/** Loads and compiles the module, and what the session begins with; none where one of them is missing or damaged. */
const load = () => Promise.all([compiled('slipfront.wasm'), textOf('start.json').catch(() => null)]);

/** @type {Promise<WebAssembly.Module|null>|null} */
let work = null;

/** The module that does the work beside the session, which is loaded when there is some; null where it is missing or damaged. */
export const loadWork = () => (work ??= compiled('slipfront-work.wasm'));

/** What is loaded of a page without a server while its other parts are; null if the browser has no SIMD. */
export const loading = isAlone && WebAssembly.validate(SIMD) ? load() : null;
