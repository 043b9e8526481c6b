// Runs cases in WebAssembly and writes the archive of each, as the page saves it.
//
//     node tests/platforms/wasm.mjs CASES.json OUT
//
// CASES.json holds a list of `{name, toml, files}`, with files in Base64; each gives OUT/NAME.zip. Needs the
// module that crates/slipfront-wasm/build.sh makes. tests/platforms/run.py calls it.
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { answer, ARCHIVE } from '../../crates/slipfront-wasm/node.mjs';

const [list, out] = process.argv.slice(2);
for (const document of JSON.parse(readFileSync(list, 'utf8'))) {
  const archive = await answer('save', [], document, ARCHIVE);
  if (archive.length === 0) throw new Error(`${document.name}: no archive was given`);
  writeFileSync(path.join(out, `${document.name}.zip`), archive);
}
