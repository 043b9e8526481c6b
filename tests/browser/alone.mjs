// Pages without a server: a folder for any web server, and one file.
import assert from 'node:assert/strict';
import { copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { pathToFileURL } from 'node:url';
import { inflateRawSync } from 'node:zlib';
import { link, ROOT, slipfront, WORK } from './command.mjs';
import { browser, colours, laboratory, open, say, SMALL, until, withoutServer } from './page.mjs';

/** The files of a ZIP archive by their names: stored or deflated, as its central directory lists them. */
function unzip(bytes) {
  const files = new Map();
  let at = bytes.readUInt32LE(bytes.lastIndexOf(Buffer.from('PK\x05\x06', 'latin1')) + 16);
  while (bytes.readUInt32LE(at) === 0x02014b50) {
    const [method, packed] = [bytes.readUInt16LE(at + 10), bytes.readUInt32LE(at + 20)];
    const [name, extra, comment] = [28, 30, 32].map((place) => bytes.readUInt16LE(at + place));
    const header = bytes.readUInt32LE(at + 42);
    const begin = header + 30 + bytes.readUInt16LE(header + 26) + bytes.readUInt16LE(header + 28);
    const contents = bytes.subarray(begin, begin + packed);
    files.set(bytes.toString('utf8', at + 46, at + 46 + name), method === 0 ? contents : inflateRawSync(contents));
    at += 46 + name + extra + comment;
  }
  return files;
}

/** Saves the run that is shown; its files. */
async function saved(lab, name) {
  await lab.press('open-keep');
  await lab.find('#save-name').fill(name);
  const { contents } = await lab.download(() => lab.press('save'));
  await lab.notice(say('saved', { folder: `${name}.zip` }));
  return unzip(contents);
}

/** Whether a file of a run is a picture. */
const isPicture = (name) => /\.(svg|png)$/.test(name);

/** Writes files into a folder of this name. */
function unpack(files, name) {
  const folder = path.join(WORK, 'unpacked', name);
  mkdirSync(folder, { recursive: true });
  for (const [file, contents] of files) writeFileSync(path.join(folder, file), contents);
  return folder;
}

/** Displacements and velocities at the instants and at the end too. */
const ALL_FIELDS = '\n[output]\nfields = ["displacement_x", "displacement_y", "velocity_x", "velocity_y", "contact_stress_star"]\n';
const CASES = {
  small: SMALL + ALL_FIELDS,
  oblique: `${SMALL.replace('[slider]', '[drive]\ndirection = 30\n\n[slider]\nedges = "periodic"')}${ALL_FIELDS}`,
  ageing: readFileSync(path.join(ROOT, 'cases/ageing.toml'), 'utf8'),
};

for (const [kept, toml] of Object.entries(CASES)) {
  test(`a run that is saved without a server has the bytes of the command: ${kept}`, withoutServer, async (t) => {
    const lab = await open(t, { toml });
    assert.equal(await lab.text('save-where'), say('save_zip'));
    const files = await saved(lab, kept);
    writeFileSync(path.join(WORK, `${kept}.toml`), lab.last.case.toml);
    const folder = path.join(WORK, 'of the command', kept);
    await slipfront('run', `${kept}.toml`, '--quiet', '--out', folder);
    const names = ['case.toml', 'fields.nc', 'kymograph.nc', 'series.csv', 'summary.json'];
    assert.deepEqual([...files.keys()].filter((name) => !isPicture(name)).sort(), [...names, 'manifest.json'].sort());
    // Every file of the command is there, pictures too, and has its bytes; the manifest tells when and where
    // it was run.
    const others = readdirSync(folder).filter((name) => !name.startsWith('.'));
    assert.deepEqual([...files.keys()].sort(), others.sort());
    for (const name of others) assert.ok(name === 'manifest.json' || files.get(name).equals(readFileSync(path.join(folder, name))), `${name} differs`);
    assert.ok(others.filter(isPicture).length >= 4, others.join(' '));
    const unpacked = unpack(files, kept);
    assert.match(await slipfront('verify', unpacked), new RegExp(`${others.length - 1} files unchanged since slipfront`));
    assert.equal(JSON.parse(files.get('manifest.json')).without_pictures, undefined);
  });
}

test('without the module for work beside the run, the run goes on, and what needs it says why', withoutServer, async (t) => {
  // Files that a service worker gives would not pass here.
  const lab = await open(t, { toml: SMALL, serviceWorkers: 'block' });
  await lab.page.route('**/slipfront-work.wasm', (route) => route.fulfill({ body: Buffer.from('\0asm damaged', 'latin1'), contentType: 'application/wasm' }));
  await lab.press('open-keep');
  await lab.find('#save-name').fill('plain');
  // The page says it, and not the session.
  await lab.press('save');
  await lab.notice('plain was not saved');
  await lab.press('pause');
  await until(() => lab.last.numbers?.step > 0, 'steps of the run');
});

test('a run that is being saved without a server can be stopped', withoutServer, async (t) => {
  const lab = await open(t, { toml: SMALL.replace('[20, 20]', '[150, 150]').replace('= 120', '= 1e5') });
  await lab.press('open-keep');
  await lab.find('#save-name').fill('long');
  await lab.press('save');
  await lab.find('#saving li').waitFor();
  await lab.find('#saving li button').click();
  await until(async () => (await lab.find('#saving li').count()) === 0, 'no row');
  // A name that is none is refused by the session.
  await lab.press('open-keep');
  await lab.find('#save-name').fill('a/b');
  await lab.after(() => lab.press('save'), 'refused', ({ sentence }) => sentence.includes('is no name for a file'));
});

test('a folder that was opened once opens without its server', withoutServer, async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.page.evaluate(async () => (await navigator.serviceWorker.ready).active.state);
  await until(() => lab.page.evaluate(async () => (await caches.keys()).length === 1 && (await (await caches.open((await caches.keys())[0])).keys()).length > 40), 'all files in the cache');
  await lab.page.context().setOffline(true);
  const before = lab.count.hello;
  await lab.page.reload();
  await until(() => lab.count.hello > before, 'a session without a network');
  await lab.page.context().setOffline(false);
});

test('a simulation that fails begins anew with the case that is shown, and is given up when it fails again and again', withoutServer, async (t) => {
  const lab = await open(t, { toml: SMALL });
  lab.breaks = true;
  // A Worker fails at a message that it does not know.
  const breakIt = () => lab.page.evaluate(() => window.workers.at(-1).postMessage({ do: 'none' }));
  await lab.after(breakIt, 'case', ({ why }) => why === 'open');
  await lab.notice(say('worker_failed'));
  for (let k = 0; k < 2; k += 1) await lab.after(breakIt, 'case', ({ why }) => why === 'open');
  await breakIt();
  await lab.notice(say('worker_lost'));
  await lab.after(() => lab.page.reload(), 'case');
});

/** Lets the page hear its first Worker beside the session only after another one has told what it has found. */
function holdFirstWorker() {
  let first = null;
  let isHeld = true;
  const held = [];
  window.Worker = class extends Worker {
    postMessage(message, ...rest) {
      if (message.do === 'run') first ??= this;
      super.postMessage(message, ...rest);
    }

    set onmessage(handle) {
      super.onmessage = (event) => {
        if (isHeld && this === first) return held.push(() => handle.call(this, event));
        handle.call(this, event);
        if (event.data.is !== 'event') return;
        isHeld = false;
        held.splice(0).forEach((hear) => hear());
      };
    }
  };
}

test('static friction over seeds is the same whichever of several Workers ends first, and no Worker stays', withoutServer, async (t) => {
  const lab = await open(t, { toml: SMALL });
  const reports = [];
  const hear = lab.hear.bind(lab);
  lab.hear = (payload) => {
    hear(payload);
    if (lab.last.repeated !== reports.at(-1)) reports.push(lab.last.repeated);
  };
  /** Begins over so many seeds, and waits until a report holds. */
  const repeat = async (seeds, holds) => {
    reports.length = 0;
    delete lab.last.repeated;
    await lab.find('#repeat-seeds').fill(String(seeds));
    await lab.press('repeat');
    await until(() => reports.length > 0 && holds(reports.at(-1)), `a report on ${seeds} seeds`);
  };
  const sessionAlone = (after) => until(() => lab.page.workers().length === 1, () => `${lab.page.workers().length} Workers after ${after}`);
  /** Reports on three seeds in a page on a machine with so many cores. */
  const onCores = async (cores) => {
    const init = (value) => Object.defineProperty(navigator, 'hardwareConcurrency', { value, configurable: true });
    await lab.page.addInitScript(init, cores);
    await lab.after(() => lab.page.reload(), 'case');
    await repeat(3, ({ finished }) => finished);
    await sessionAlone('the last seed');
    assert.equal(await lab.page.evaluate(() => window.workers.length), cores, 'the session and a Worker for each further core');
    return [...reports];
  };
  const inOrder = await onCores(2);
  assert.deepEqual(inOrder.map(({ done }) => done), [1, 2, 3]);
  await lab.page.addInitScript(holdFirstWorker);
  assert.deepEqual(await onCores(3), inOrder);
  // Many seeds of a larger slider are not done before they are ended.
  const large = link(SMALL.replace('[20, 20]', '[60, 60]'));
  await lab.after(() => lab.page.evaluate((hash) => (location.hash = hash), `#case=${large}`), 'case', ({ blocks }) => blocks[0] === 60);
  const ends = {
    stop: () => lab.press('repeat'),
    edit: () => lab.find('#control-r_star').fill('0.4').then(() => lab.find('#control-r_star').press('Enter')),
    open: () => lab.page.evaluate(() => (location.hash = '#preset=circle')),
  };
  for (const [name, end] of Object.entries(ends)) {
    await repeat(32, ({ done }) => done > 0);
    await lab.reads('repeat', say('repeat_stop'));
    await end();
    await sessionAlone(name);
    await lab.reads('repeat', say('repeat'));
    assert.ok(reports.at(-1).finished && reports.at(-1).done < 32, `${name}: ${JSON.stringify(reports.at(-1))}`);
  }
});

test('one file opens from the disk, draws, and asks for nothing', withoutServer, async (t) => {
  const file = path.join(WORK, 'single page.html');
  await slipfront('lab', '--single', file);
  const begin = performance.now();
  const lab = await open(t, { address: `${pathToFileURL(file)}#`, toml: SMALL, calm: false });
  t.diagnostic(`first picture of one file after ${((performance.now() - begin) / 1000).toFixed(2)} s`);
  await lab.runToEnd();
  assert.ok(colours(await lab.find('#canvas').screenshot()) > 16);
  // Lessons and their cases stand in it.
  await lab.press('open-lessons');
  await lab.after(() => lab.find('#lessons-list button').first().click(), 'case');
  const files = await saved(lab, 'single');
  assert.ok(files.has('series.csv'));
});

test('a module that is damaged, and a browser without SIMD, are said in a sentence', withoutServer, async (t) => {
  const context = await browser.newContext();
  t.after(() => context.close());
  const page = await context.newPage();
  await page.route('**/slipfront.wasm', (route) => route.fulfill({ body: Buffer.from('\0asm damaged', 'latin1'), contentType: 'application/wasm' }));
  await page.goto(laboratory.address);
  const told = (sentence) => until(async () => (await page.locator('#notices').textContent()).includes(sentence), sentence);
  await told(say('no_module'));
  await page.unroute('**/slipfront.wasm');
  await page.addInitScript(() => (WebAssembly.validate = () => false));
  await page.reload();
  await told(say('no_simd'));
});

test('the command refuses what it cannot export', withoutServer, async () => {
  const refused = async (...options) => {
    const failed = await slipfront('lab', ...options).then(() => null, (error) => error);
    assert.ok(failed, options.join(' '));
    return failed.stderr;
  };
  const folder = path.join(WORK, 'not exported');
  mkdirSync(folder);
  writeFileSync(path.join(folder, 'mine.txt'), 'mine');
  assert.match(await refused('--export', folder), /holds other things than an exported laboratory/);
  assert.deepEqual(readdirSync(folder), ['mine.txt']);
  assert.match(await refused('--single', path.join(WORK, 'x.html'), 'none.toml'), /none\.toml/);
  // What was exported is replaced.
  const again = path.join(WORK, 'again exported');
  await slipfront('lab', '--export', again);
  copyFileSync(path.join(again, 'index.html'), path.join(again, 'index.old'));
  await slipfront('lab', '--export', again);
  assert.equal(readFileSync(path.join(again, 'index.html'), 'utf8'), readFileSync(path.join(again, 'index.old'), 'utf8'));
  assert.doesNotMatch(readFileSync(path.join(again, 'index.html'), 'utf8'), /https?:/);
});
