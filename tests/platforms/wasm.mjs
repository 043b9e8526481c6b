// Runs cases in WebAssembly and writes the archive of each, as the page saves it.
//
//     node tests/platforms/wasm.mjs CASES.json OUT
//
// CASES.json holds a list of `{name, toml, files}`, with files in Base64; each gives OUT/NAME.zip. Needs target/slipfront.wasm
// (crates/slipfront-wasm/build.sh). tests/platforms/run.py calls it.
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const ROOT = fileURLToPath(new URL('../..', import.meta.url));
/** What the module says, by its number in `imports.rs` of slipfront-wasm. */
const [ARCHIVE, REFUSAL, DEFECT] = [9, 11, 12];

const module = await WebAssembly.compile(readFileSync(path.join(ROOT, 'target/slipfront.wasm')));
const [list, out] = process.argv.slice(2);
for (const document of JSON.parse(readFileSync(list, 'utf8'))) {
  let archive;
  const say = (what, _number, at, length) => {
    const bytes = Buffer.from(exports.memory.buffer, at, length);
    if (what === ARCHIVE) archive = Buffer.from(bytes);
    else if (what === REFUSAL || what === DEFECT) throw new Error(`${document.name}: ${bytes}`);
  };
  const { exports } = await WebAssembly.instantiate(module, { env: { say, now: () => performance.now() } });
  exports.begin();
  const given = Buffer.from(JSON.stringify(document));
  const at = exports.room(given.length);
  new Uint8Array(exports.memory.buffer, at, given.length).set(given);
  exports.save();
  if (archive === undefined) throw new Error(`${document.name}: no archive was given`);
  writeFileSync(path.join(out, `${document.name}.zip`), archive);
}
