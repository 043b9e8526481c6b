// The command `slipfront`, and the laboratories that it starts.
import { execFile, spawn } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { deflateRawSync } from 'node:zlib';

export const ROOT = fileURLToPath(new URL('../..', import.meta.url));
const COMMAND = path.resolve(process.env.SLIPFRONT ?? path.join(ROOT, 'target/debug/slipfront'));

mkdirSync(path.join(ROOT, 'target'), { recursive: true });
/** A folder of this run of the tests, and the folder of results of the laboratory in it. */
export const WORK = mkdtempSync(path.join(ROOT, 'target/browser.'));
export const RESULTS = path.join(WORK, 'results');
process.on('exit', () => rmSync(WORK, { recursive: true, force: true }));

/** Runs the command to its end; returns what it printed. */
export async function slipfront(...options) {
  return (await promisify(execFile)(COMMAND, options, { cwd: WORK })).stdout;
}

/** Starts a laboratory; returns the address that it prints, what stops it, and what kills it. */
export const startLaboratory = (...options) => start(['--no-open', ...options], process.env);

/** Starts a laboratory with a desktop whose programs write into a file what they shall open; returns that too. */
export async function startOnDesktop() {
  const folder = mkdtempSync(path.join(WORK, 'desktop.'));
  const opened = path.join(folder, 'opened');
  // No program is known for any kind of file.
  for (const [name, script] of [['xdg-mime', 'exit 4'], ['xdg-open', `printf %s "$1" > ${opened}.new; mv ${opened}.new ${opened}`]]) {
    writeFileSync(path.join(folder, name), `#!/bin/sh\n${script}\n`, { mode: 0o755 });
  }
  const laboratory = await start([], { ...process.env, PATH: `${folder}:${process.env.PATH}`, BROWSER: '' });
  return { opened, ...laboratory };
}

async function start(options, env) {
  const child = spawn(COMMAND, ['lab', '--results', RESULTS, ...options], { cwd: WORK, stdio: ['ignore', 'pipe', 'inherit'], env });
  const ended = new Promise((resolve) => child.once('exit', resolve));
  const address = await new Promise((resolve, reject) => {
    let printed = '';
    child.stdout.on('data', (text) => {
      printed += text;
      const found = /(http:\S+)\n/.exec(printed);
      if (found) resolve(found[1]);
    });
    ended.then(() => reject(new Error(`slipfront lab ended before it printed an address: ${printed}`)));
  });
  const end = (signal) => {
    child.kill(signal);
    return ended;
  };
  return { address, stop: () => end('SIGTERM'), kill: () => end('SIGKILL') };
}

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json', '.wasm': 'application/wasm' };

/** Serves an exported laboratory, not at the root of its server; returns its address, which a case can follow, and what stops it. */
export async function serveExported() {
  const folder = path.join(WORK, 'exported');
  await slipfront('lab', '--export', folder);
  const server = createServer(({ url }, response) => {
    const name = decodeURI(url.split('?')[0]).replace(/^\/some\/where\//, '');
    const file = path.join(folder, name === '' ? 'index.html' : name);
    if (!url.startsWith('/some/where/') || !existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { 'content-type': TYPES[path.extname(file)] ?? 'text/plain' }).end(readFileSync(file));
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const stop = () => {
    server.closeAllConnections();
    return new Promise((resolve) => server.close(resolve));
  };
  return { address: `http://127.0.0.1:${server.address().port}/some/where/#`, folder, stop };
}

/** A case as part of an address, as the page makes it. */
export const link = (toml, files = {}) => deflateRawSync(JSON.stringify({ toml, files })).toString('base64url');
