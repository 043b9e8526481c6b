// Holds the bits of runs in WebAssembly to those of this machine: mu*, displacements and velocities of every
// case at its end, or after 3000 steps.
//
//     node crates/slipfront-wasm/bits.mjs
//
// Needs target/slipfront-work.wasm (build.sh) and the example `bits`, which `cargo test --workspace` builds too.
import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { answer, BITS, ROOT } from './node.mjs';

const MOST_STEPS = 3000;

const folder = path.join(ROOT, 'cases');
const names = readdirSync(folder).filter((name) => name.endsWith('.toml'));
const here = execFileSync(path.join(ROOT, 'target/debug/examples/bits'), [String(MOST_STEPS), ...names.map((name) => path.join(folder, name))], { encoding: 'utf8' });
const wanted = new Map(here.trim().split('\n').map((line) => line.split(/ (.*)/).slice(0, 2)));

/** The files that a case names: every one beside it whose name stands in its text. @param {string} toml */
function filesOf(toml) {
  const others = readdirSync(folder).filter((name) => !name.endsWith('.toml') && toml.includes(`"${name}"`));
  return Object.fromEntries(others.map((name) => [name, [...readFileSync(path.join(folder, name))]]));
}

/** The bits of a case in WebAssembly. @param {string} toml */
const bitsOf = async (toml) => (await answer('bits', [MOST_STEPS], { toml, files: filesOf(toml) }, BITS)).toString();

let differ = 0;
for (const name of names) {
  const found = await bitsOf(readFileSync(path.join(folder, name), 'utf8'));
  const own = wanted.get(name.replace(/\.toml$/, ''));
  if (found !== own) {
    differ += 1;
    console.error(`${name}: ${found} in WebAssembly, and ${own} on this machine`);
  }
}
if (names.length === 0 || wanted.size !== names.length) throw new Error(`${wanted.size} of ${names.length} cases were run`);
console.log(`${names.length - differ} of ${names.length} cases have the same bits in WebAssembly`);
process.exit(differ === 0 ? 0 : 1);
