// The modules of the laboratory in Node.js, for tests: target/slipfront.wasm and
// target/slipfront-pictures.wasm, which build.sh makes.
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

export const ROOT = fileURLToPath(new URL('../..', import.meta.url));
/** What the modules say, by its number in `imports.rs`. */
export const [ARCHIVE, BITS, REFUSAL, DEFECT, PICTURES] = [9, 10, 11, 12, 13];

/** @param {string} name */
const compiled = (name) => WebAssembly.compile(readFileSync(path.join(ROOT, 'target', name)));
const session = await compiled('slipfront.wasm');

/** Gives a module bytes. */
function give(to, bytes) {
  const at = to.room(bytes.length);
  new Uint8Array(to.memory.buffer, at, bytes.length).set(bytes);
}

/** Begins a module; `hear` gets all that it says, with the kind before. */
async function begin(module, hear, others = {}) {
  const say = (what, _number, at, length) => {
    const bytes = Buffer.from(Buffer.from(exports.memory.buffer, at, length));
    if (what === REFUSAL || what === DEFECT) throw new Error(bytes.toString());
    hear(what, bytes);
  };
  const { exports } = await WebAssembly.instantiate(module, { env: { say, ...others } });
  exports.begin();
  return exports;
}

/** Gives the answer of this kind when the function of the session is called with something as JSON. Where the session asks for pictures, they are
 *  drawn if `draws` says so.
 *  @param {string} name @param {number[]} values @param {unknown} given @param {number} kind @param {boolean} [draws] */
export async function answer(name, values, given, kind, draws = false) {
  let [said, drawn] = [Buffer.alloc(0), Buffer.alloc(0)];
  const pictures = draws ? await begin(await compiled('slipfront-pictures.wasm'), (_, bytes) => (drawn = bytes)) : null;
  const others = {
    now: () => performance.now(),
    date: () => give(exports, Buffer.from(new Date().toISOString())),
    draw: (at, length) => {
      if (pictures) {
        give(pictures, Buffer.from(exports.memory.buffer, at, length));
        pictures.draw();
      }
      give(exports, drawn);
    },
  };
  const exports = await begin(session, (what, bytes) => what === kind && (said = bytes), others);
  give(exports, Buffer.from(JSON.stringify(given)));
  exports[name](...values);
  return said;
}
