// What is kept of a run: links, cases, run folders with the bytes of the command, pictures, clips.
import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { PNG } from 'pngjs';
import { link, RESULTS, slipfront, startLaboratory, WORK } from './command.mjs';
import { colours, IS_ALONE, Lab, onServer, open, say, SMALL, sleep, until, untilSame } from './page.mjs';
import { image } from './texture.mjs';

const permissions = ['clipboard-read', 'clipboard-write'];

async function copyLink(lab) {
  await lab.press('open-keep');
  await lab.press('copy-link');
  await lab.notice(say(IS_ALONE ? 'link_copied' : 'link_copied_server'));
  return lab.page.evaluate(() => navigator.clipboard.readText());
}

/** The picture of the first slips when the run has ended. */
async function firstSlips(lab) {
  await lab.find('#field').selectOption('first_slip');
  const { summary } = await lab.runToEnd();
  const { values } = await until(() => lab.last.picture.field === 5 && lab.last.picture, 'the field of first slips');
  return { summary, values };
}

test('a link opens the same case, which runs the same way', async (t) => {
  const lab = await open(t, { toml: SMALL, permissions });
  await lab.press('tool-brush');
  // Five rows of four blocks and eight beyond each end, none of which the cavity has.
  const percent = lab.last.case.texture_percent + 100 * (5 * 4 + 2 * 8) / 400;
  await lab.after(() => lab.drag([3.5, 3.5], [6.5, 3.5]), 'case', (shown) => shown.texture_percent === percent);
  const address = await copyLink(lab);
  assert.match(address, IS_ALONE ? /^http:\/\/127\.0\.0\.1:\d+\/some\/where\/#case=[\w-]+$/ : /^http:\/\/127\.0\.0\.1:\d+\/#case=[\w-]+$/);
  // The token of a link is the reader's own.
  const other = await open(t, { address: `${lab.address}&${new URL(address).hash.slice(1)}` });
  assert.equal(other.last.case.toml, lab.last.case.toml);
  assert.equal(other.last.case.texture_percent, lab.last.case.texture_percent);
  const [one, two] = [await firstSlips(lab), await firstSlips(other)];
  assert.deepEqual(two.summary, one.summary);
  assert.ok(one.values.equals(two.values), 'other blocks slip at other times');
  assert.ok(one.values.some((value) => value <= 250), 'no block has slipped');
  // The command starts with the case of a link, whichever page it is of.
  const started = await startLaboratory(address);
  t.after(started.stop);
  assert.ok(started.address.endsWith(`&case=${address.split('#case=')[1]}`), started.address);
  if (IS_ALONE) return;
  const third = await open(t, { address: started.address });
  assert.equal(third.last.case.toml, lab.last.case.toml);
});

test('a copied link opens in another tab of the browser, which has no token, with the page it was copied from', onServer, async (t) => {
  const lab = await open(t, { toml: SMALL, permissions });
  const address = await copyLink(lab);
  const { toml } = lab.last.case;
  await lab.after(() => lab.find('#control-seed').fill('7').then(() => lab.find('#control-seed').press('Enter')), 'case');
  const tab = async (hash) => {
    const other = new Lab(await lab.page.context().newPage(), address);
    await other.load(address.replace(/#.*/, hash));
    await other.notice(say('opened_elsewhere'));
    assert.deepEqual([other.faults, other.sockets], [[], 0]);
  };
  await lab.after(() => tab(new URL(address).hash), 'case', (shown) => shown.toml === toml);
  await lab.after(() => tab('#case=gear'), 'case', ({ name }) => name === 'gear');
  assert.equal(lab.sockets, 1);
});

test('the texture is kept as outlines, for a laser and for a drawing program', async (t) => {
  const lab = await open(t, { toml: SMALL });
  for (const [format, ofTexture] of [['dxf', /TEXTURE_1/], ['svg', /<g[^>]*TEXTURE_1/]]) {
    await lab.press('open-keep');
    const { name, contents } = await lab.download(() => lab.press(`drawing-${format}`));
    assert.equal(name, `case.${format}`);
    assert.equal(contents.toString(), lab.last.drawing.text);
    assert.match(contents.toString(), ofTexture);
    for (const note of lab.last.drawing.notes) await lab.notice(note);
    // A circle of a tenth of 20 um x 20 um, in millimetres: its radius is sqrt(0.1/pi) 0.02.
    const radius = Math.sqrt(0.1 / Math.PI) * 0.02;
    const numbers = contents.toString().match(/-?\d+(\.\d+)?(e-?\d+)?/g).map(Number);
    // Coordinates are written with at least six digits.
    assert.ok(numbers.some((value) => Math.abs(value - radius) < 1e-5 * radius), `no radius ${radius} in ${contents}`);
  }
});

test('a case too large for a link is downloaded instead', async (t) => {
  // Every pixel is at random below or above the threshold, by a generator of 32 bits: nothing in it can be
  // packed.
  let random = 1;
  const noise = image(200, () => (random = (Math.imul(random, 1664525) + 1013904223) >>> 0) >>> 24);
  // As many blocks as pixels, since no more pixels are kept.
  const lab = await open(t, { toml: SMALL.replace('[20, 20]', '[200, 200]') });
  await lab.after(() => lab.find('#image-file').setInputFiles({ name: 'noise.png', mimeType: 'image/png', buffer: noise }), 'case', ({ texture }) => texture[0].shape === 'mask');
  await lab.press('open-keep');
  await lab.press('copy-link');
  await lab.notice(say('link_too_long'));
  await lab.press('open-keep');
  const { contents } = await lab.download(() => lab.press('download-case'));
  assert.equal(contents.subarray(0, 2).toString(), 'PK');
});

test('a run that is saved has the bytes of the command', onServer, async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.press('open-keep');
  const { name, contents } = await lab.download(() => lab.press('download-case'));
  assert.equal(contents.toString(), lab.last.case.toml);
  await lab.press('open-keep');
  await lab.find('#save-name').fill('kept');
  const { folder } = await lab.after(() => lab.press('save'), 'saved');
  await lab.notice(say('saved', { folder }));
  const kept = path.join(RESULTS, 'kept');
  const again = path.join(WORK, 'again/kept');
  writeFileSync(path.join(WORK, name), contents);
  await slipfront('run', name, '--quiet', '--out', again);
  const files = readdirSync(kept, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile()).map((entry) => path.relative(kept, path.join(entry.path, entry.name)));
  assert.ok(files.includes('summary.json') && files.includes('series.csv') && files.includes('case.toml'), files.join(' '));
  assert.deepEqual(readdirSync(again, { recursive: true }).sort(), readdirSync(kept, { recursive: true }).sort());
  for (const file of files.filter((name) => name !== 'manifest.json')) {
    assert.ok(readFileSync(path.join(kept, file)).equals(readFileSync(path.join(again, file))), `${file} differs`);
  }
  // A name that is taken is refused.
  await lab.press('open-keep');
  await lab.find('#save-name').fill('kept');
  await lab.after(() => lab.press('save'), 'refused', ({ of }) => of === 'save');
});

/** A run that takes longer than a page needs to be loaded: some seconds, or minutes. */
const takes = (blocks, duration) => SMALL.replace('[20, 20]', `[${blocks}, ${blocks}]`).replace('= 120', `= ${duration}`);

async function beginToSave(lab, name) {
  await lab.press('open-keep');
  await lab.find('#save-name').fill(name);
  await lab.after(() => lab.press('save'), 'saving', ({ under_way: all }) => all.some((one) => one.name === name));
  await lab.find('#saving li').last().waitFor();
}

test('a run goes on being saved when its page is loaded again or closed, and is whole', onServer, async (t) => {
  const lab = await open(t, { toml: takes(60, 3000) });
  await beginToSave(lab, 'reloaded');
  await lab.after(() => lab.page.reload(), 'saving', ({ under_way: all }) => all.length === 1);
  assert.match(await lab.find('#saving li span').textContent(), /reloaded/);
  const folder = path.join(RESULTS, 'reloaded');
  await lab.notice(say('saved', { folder }));
  assert.equal(await lab.find('#saving').isVisible(), false);
  assert.match(await slipfront('verify', folder), /unchanged since slipfront [^ ]+ .*wrote them/);
  // It can be opened without loading the page once more.
  await lab.press('open-presets');
  await lab.find('#presets-search').fill('reloaded');
  await lab.after(() => lab.find('#presets-search').press('Enter'), 'case', ({ name }) => name === 'reloaded');
  // A list that is open has a new run at once.
  await beginToSave(lab, 'listed');
  await lab.press('open-presets');
  await until(async () => (await lab.text('presets-list')).includes('listed'), 'the run in the list');
  await lab.page.keyboard.press('Escape');
  await beginToSave(lab, 'closed');
  await lab.page.close();
  const closed = path.join(RESULTS, 'closed');
  await until(() => existsSync(path.join(closed, 'manifest.json')), 'the run of a page that was closed');
  assert.match(await slipfront('verify', closed), /unchanged since slipfront [^ ]+ .*wrote them/);
});

test('saves that another page has begun are shown, and can be stopped', onServer, async (t) => {
  const lab = await open(t, { toml: takes(150, 1e5) });
  await beginToSave(lab, 'one');
  await beginToSave(lab, 'two');
  const other = await open(t, { toml: SMALL });
  await until(async () => (await other.find('#saving li').count()) === 2, 'two rows');
  await other.find('#saving li[data-name=one] button').click();
  await until(async () => (await lab.find('#saving li').allTextContents()).join().includes('one') === false, 'one row');
  await lab.find('#saving li button').click();
  await until(() => other.last.saving.under_way.length === 0, 'no save');
  assert.equal(await other.find('#saving').isVisible(), false);
  assert.deepEqual(readdirSync(RESULTS).filter((name) => ['one', 'two'].includes(name)), []);
});

test('panels are kept as pictures', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.runToEnd();
  await sleep(600);
  for (const panel of ['field', 'curves', 'kymograph']) {
    await lab.press('open-keep');
    const { name, contents } = await lab.download(() => lab.press(`png-${panel}`));
    assert.match(name, new RegExp(`-${panel}\\.png$`));
    const { width, height } = PNG.sync.read(contents);
    if (panel === 'curves') assert.deepEqual([width, height], [1600, 1000]);
    // The kymograph has the colours of its bar, beyond those of what it shows, which is dark or bright.
    if (panel === 'kymograph') assert.ok(colours(contents) > 200, `${colours(contents)} colours`);
    assert.ok(width >= 300 && width <= 4000 && height >= 150 && height <= 4000, `${panel}: ${width} x ${height}`);
    assert.ok(colours(contents) > 20, `${panel} has ${colours(contents)} colours`);
  }
});

test('the picture of the curves names them', async (t) => {
  const lab = await open(t, { toml: SMALL, colorScheme: 'light' });
  await lab.runToEnd();
  await sleep(600);
  const ofCurves = async () => {
    await lab.press('open-keep');
    const { data, width } = PNG.sync.read((await lab.download(() => lab.press('png-curves'))).contents);
    // The row through the pieces of line of the legend.
    const y = 2 * (12 + 24 + 7);
    const seen = new Set();
    for (let x = 0; x < width; x++) seen.add([...data.subarray(4 * (y * width + x), 4 * (y * width + x) + 3)].join());
    return seen;
  };
  const [run, ghost] = await lab.page.evaluate(() => ['--curve', '--ghost'].map((name) => {
    const sample = document.body.appendChild(document.createElement('i'));
    sample.style.color = `var(${name})`;
    return getComputedStyle(sample).color.match(/\d+/g).join();
  }));
  const both = await ofCurves();
  assert.ok(both.has(run) && both.has(ghost), [...both].join(' '));
});

test('the picture of the curves is the same whatever was open before', async (t) => {
  const other = SMALL.replace('coverage = 10', 'coverage = 20');
  const picture = async (lab) => {
    await lab.runToEnd();
    await untilSame(() => lab.count.curve, 'no more points of a curve');
    await lab.press('open-keep');
    return (await lab.download(() => lab.press('png-curves'))).contents;
  };
  const lab = await open(t, { toml: SMALL });
  await picture(lab);
  // Both have the same slider without texture, whose run has ended by now.
  await lab.after(() => lab.page.evaluate((hash) => (location.hash = hash), `#case=${link(other)}`), 'case', ({ why }) => why === 'open');
  const after = await picture(lab);
  assert.ok(after.equals(await picture(await open(t, { toml: other }))));
});

test('a clip of a run that has ended shows it again from rest', async (t) => {
  const lab = await open(t, { toml: SMALL, calm: false });
  await lab.runToEnd();
  await lab.find('#pace').press('PageDown');
  await lab.press('open-keep');
  // It stops by itself at the end of the run.
  const { contents } = await lab.download(() => lab.press('clip'));
  assert.equal(contents.subarray(0, 4).toString('hex'), '1a45dfa3');
  assert.equal(lab.last.numbers.ended, true);
  // A run that stands still has one picture at least.
  await lab.find('#pace').press('Home');
  await lab.after(() => lab.press('rest'), 'numbers', ({ ended }) => !ended);
  await lab.press('pause');
  await lab.press('open-keep');
  await lab.press('clip');
  const still = await lab.download(() => lab.press('clip-running'));
  assert.ok(still.contents.length > 1000, `${still.contents.length} bytes`);
});

test('a clip is recorded', async (t) => {
  const lab = await open(t, { toml: SMALL.replace('[20, 20]', '[50, 50]'), calm: false });
  // Blocks that move at different speeds give the clip something to tell.
  await lab.find('#field').selectOption('speed');
  await lab.press('open-keep');
  await lab.press('clip');
  await lab.press('rest');
  await sleep(2000);
  const { name, contents } = await lab.download(() => lab.press('clip-running'));
  assert.match(name, /\.webm$/);
  // The first bytes of EBML, of which WebM is a kind.
  assert.equal(contents.subarray(0, 4).toString('hex'), '1a45dfa3');
  assert.ok(contents.length > 20_000, `${contents.length} bytes`);
});
