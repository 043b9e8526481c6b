// The module of work beside a session in Node.js, for tests: target/slipfront-work.wasm, which build.sh makes.
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

export const ROOT = fileURLToPath(new URL('../..', import.meta.url));
/** What the module says, by its number in `imports.rs`. */
export const [ARCHIVE, BITS, REFUSAL, DEFECT] = [9, 10, 11, 12];

const work = await WebAssembly.compile(readFileSync(path.join(ROOT, 'target/slipfront-work.wasm')));

/** Gives the answer of this kind when a function of the module is called with something as JSON.
 *  @param {string} name @param {number[]} values @param {unknown} given @param {number} kind */
export async function answer(name, values, given, kind) {
  let answered = Buffer.alloc(0);
  const give = (bytes) => {
    const at = exports.room(bytes.length);
    new Uint8Array(exports.memory.buffer, at, bytes.length).set(bytes);
  };
  const say = (what, _number, at, length) => {
    const bytes = Buffer.from(Buffer.from(exports.memory.buffer, at, length));
    if (what === REFUSAL || what === DEFECT) throw new Error(bytes.toString());
    if (what === kind) answered = bytes;
  };
  const date = () => give(Buffer.from(new Date().toISOString()));
  const { exports } = await WebAssembly.instantiate(work, { env: { say, now: () => performance.now(), date } });
  exports.begin();
  give(Buffer.from(JSON.stringify(given)));
  exports[name](...values);
  return answered;
}
