// @ts-check
// The simulation as WebAssembly, of a page without a server: index.html begins with this script, so that it is loaded and compiled while all
// others are.
import { bytesOf, isAlone, textOf } from './assets.js';

/** A module without a function, of which one instruction is of SIMD. */
const SIMD = Uint8Array.of(0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11);

/** Loads and compiles the module, and what the session begins with; none where one of them is missing or damaged. */
async function load() {
  const compiled = async () => {
    const bytes = await bytesOf('slipfront.wasm');
    return bytes && WebAssembly.compile(bytes);
  };
  return Promise.all([compiled().catch(() => null), textOf('start.json').catch(() => null)]);
}

/** What is loaded of a page without a server while its other parts are; null if the browser has no SIMD. */
export const loading = isAlone && WebAssembly.validate(SIMD) ? load() : null;
