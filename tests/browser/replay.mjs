// A run folder again, beside what it recorded.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { RESULTS, ROOT, slipfront, WORK } from './command.mjs';
import { onServer, open, say, SMALL, until, withoutServer } from './page.mjs';

test('a recorded run is shown with its curve and its snapshots', onServer, async (t) => {
  const file = path.join(WORK, 'recorded.toml');
  writeFileSync(file, `${SMALL}\n[output]\nsnapshots = [20, 60, 90]\n`);
  await slipfront('run', file, '--quiet', '--out', path.join(RESULTS, 'recorded'));
  const lab = await open(t, {});
  assert.equal(await lab.find('#replay-row').isVisible(), false);
  await lab.press('open-presets');
  await lab.find('#presets-search').fill('recorded');
  const recorded = await lab.after(() => lab.find('#presets-list button').last().click(), 'recorded');
  assert.deepEqual(recorded.times_star, [20, 60, 90]);
  const { recorded_t: times, recorded_mu: mus } = await until(() => lab.last.curve?.recorded_t?.length > 0 && lab.last.curve, 'the recorded curve');
  assert.ok(times.at(-1) > 119 && mus.length === times.length);
  await until(() => lab.find('#curve-recorded').isVisible(), 'the name of the recorded curve');
  for (const [k, time] of recorded.times_star.entries()) {
    const picture = await lab.after(() => lab.find('#replay').press('ArrowRight'), 'picture', (came) => came.recorded && Math.abs(came.t - time) < 1e-3);
    await lab.reads('replay-value', say('replay_at', { t: time.toFixed(1) }));
    assert.equal(picture.values.length, 400, `snapshot ${k}`);
  }
  await lab.after(() => lab.find('#replay').press('Home'), 'picture', (came) => !came.recorded);
  await lab.reads('replay-value', say('replay_live'));
});

/** The folder of a run of the small slider with snapshots, by the command. */
async function runFolder(name) {
  const file = path.join(WORK, `${name}.toml`);
  writeFileSync(file, `${SMALL}\n[output]\nsnapshots = [20, 60, 90]\n`);
  const folder = path.join(WORK, 'of the command', name);
  await slipfront('run', file, '--quiet', '--out', folder);
  return folder;
}

/**
 * Drops a folder as a browser gives it: entries with a name and `inner` entries, or `bytes` in Base64, or a `size` without any, or a file that `fails`
 * to be read; `copies` of an entry have a number behind their name.
 */
const dropEntry = (lab, entry) => lab.page.evaluate((dropped) => {
  const contents = (base64) => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  const entryOf = ({ name, inner, bytes, size, fails }) => ({
    name,
    isFile: !inner,
    isDirectory: Boolean(inner),
    file: (take, refuse) => (fails ? refuse(new DOMException('gone', 'NotFoundError')) : take(size ? Object.defineProperty(new File([], name), 'size', { value: size }) : new File([contents(bytes)], name))),
    createReader: () => {
      const left = inner.flatMap(({ copies, ...one }) => (copies ? Array.from({ length: copies }, (_, k) => entryOf({ ...one, name: `${one.name}${k}` })) : [entryOf(one)]));
      return { readEntries: (take) => take(left.splice(0, 100)) };
    },
  });
  const event = new Event('drop', { bubbles: true, cancelable: true });
  Object.defineProperty(event, 'dataTransfer', { value: { items: [{ webkitGetAsEntry: () => entryOf(dropped) }], files: [] } });
  document.body.dispatchEvent(event);
}, entry);

/** A folder of the disk as an entry. */
const entryOf = (folder) => ({
  name: path.basename(folder),
  inner: readdirSync(folder, { withFileTypes: true }).map((entry) => (entry.isDirectory() ? entryOf(path.join(folder, entry.name)) : { name: entry.name, bytes: readFileSync(path.join(folder, entry.name), 'base64') })),
});

/** Drops a folder on the page: its files, and one of its folders. */
const drop = (lab, folder) => dropEntry(lab, entryOf(folder));

/** Chooses a folder in the list of cases. */
async function choose(lab, folder) {
  await lab.press('open-presets');
  const [chooser] = await Promise.all([lab.page.waitForEvent('filechooser'), lab.press('open-run')]);
  await chooser.setFiles(folder);
}

for (const [how, take] of Object.entries({ dropped: drop, chosen: choose })) {
  test(`the folder of a run is replayed: ${how}`, async (t) => {
    const folder = await runFolder(how);
    const lab = await open(t, { toml: SMALL });
    const recorded = await lab.after(() => take(lab, folder), 'recorded');
    assert.deepEqual(recorded.times_star, [20, 60, 90]);
    assert.equal(lab.last.case.name, how);
    await lab.reads('case-name', how);
    const { recorded_mu: mus } = await until(() => lab.last.curve?.recorded_t?.length > 0 && lab.last.curve, 'the recorded curve');
    const picture = await lab.after(() => lab.find('#replay').press('ArrowRight'), 'picture', (came) => came.recorded && Math.abs(came.t - 20) < 1e-3);
    assert.equal(picture.values.length, 400);
    // The bits are the same again.
    await lab.find('#replay').press('Home');
    assert.equal((await lab.runToEnd()).summary.mu_star_max, Math.max(...mus));
  });
}

test('a folder that is no run, or was changed, is refused in a sentence, and the case stays', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const { toml } = lab.last.case;
  const none = path.join(WORK, 'none');
  mkdirSync(none);
  writeFileSync(path.join(none, 'notes.txt'), 'no run');
  await lab.after(() => drop(lab, none), 'refused');
  await lab.notice('none is no folder of a run: it has no case.toml');
  const folder = await runFolder('changed');
  const series = readFileSync(path.join(folder, 'series.csv'), 'utf8');
  writeFileSync(path.join(folder, 'series.csv'), series.replace(/1/, '2'));
  await lab.after(() => drop(lab, folder), 'refused');
  await lab.notice('series.csv has other bytes than its run has written');
  copyFileSync(path.join(WORK, 'changed.toml'), path.join(folder, 'manifest.json'));
  const { sentence } = await lab.after(() => drop(lab, folder), 'refused');
  assert.match(sentence, /manifest\.json is damaged/);
  assert.equal(lab.last.case.toml, toml);
});

/** A text in Base64. */
const text = (words) => Buffer.from(words).toString('base64');

test('folders that are odd or hostile are refused in a sentence, and the page goes on', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const { toml } = lab.last.case;
  const whole = entryOf(await runFolder('hostile'));
  const other = path.join(WORK, 'hostile-other.toml');
  writeFileSync(other, `${SMALL}\n[output]\nsnapshots = [30]\n`);
  const otherFolder = path.join(WORK, 'of the command', 'hostile-other');
  await slipfront('run', other, '--quiet', '--out', otherFolder);
  const bytesOf = (name) => whole.inner.find((entry) => entry.name === name).bytes;
  const including = (...entries) => ({ name: 'odd', inner: [...whole.inner, ...entries] });
  const instead = (name, entry) => ({ name: 'odd', inner: [...whole.inner.filter((one) => one.name !== name), { name, ...entry }] });
  const tooLarge = /has more than the [\d.]+ MiB that this page can take/;
  const cases = [
    [{ name: 'empty', inner: [] }, /empty is no folder of a run: it has no/],
    // A name that is none for a folder is replaced.
    [{ name: '<img src=x onerror=alert(1)>', inner: [] }, /run is no folder of a run/],
    [{ name: 'x'.repeat(10_000), inner: [] }, /run is no folder of a run/],
    [{ name: 'many', inner: [{ name: 'file', copies: 10_000, bytes: text('x') }] }, /many is no folder of a run/],
    [{ name: 'inputs', inner: [{ name: 'inputs', inner: [{ name: 'file', copies: 10_000, bytes: text('x') }] }] }, /inputs is no folder of a run/],
    [{ name: 'deep', inner: [Array.from({ length: 20 }).reduce((inner) => ({ name: 'inputs', inner: [inner] }), { name: 'case.toml', bytes: text('x') })] }, /deep is no folder of a run/],
    [{ name: 'gone', inner: [{ name: 'case.toml', fails: true }] }, say('run_unreadable', { name: 'gone' })],
    [{ name: 'endless', inner: [{ name: 'case.toml', size: 2 ** 40 }] }, tooLarge],
    [instead('manifest.json', { size: 2 ** 40 }), tooLarge],
    [including({ name: 'inputs', inner: [{ name: 'map.npy', size: 2 ** 40 }] }), tooLarge],
    [instead('manifest.json', { bytes: readFileSync(path.join(otherFolder, 'manifest.json'), 'base64') }), /has other bytes than its run has written/],
    [instead('manifest.json', { bytes: text('['.repeat(1_000_000)) }), /manifest\.json is damaged/],
    [instead('manifest.json', { bytes: '' }), /manifest\.json/],
    [instead('fields.nc', { bytes: bytesOf('fields.nc').slice(0, 1000) }), /fields\.nc has other bytes than its run has written/],
    [instead('case.toml', { bytes: Buffer.from(Array.from({ length: 1000 }, (_, k) => k)).toString('base64') }), /case\.toml has other bytes than its run has written/],
    // A zip is no folder, and of two files of one name there is the last.
    [including({ name: 'series.csv', bytes: text('PK\u0003\u0004') }), /series\.csv has other bytes than its run has written/],
  ];
  for (const [entry, sentence] of cases) {
    await lab.find('#notices button').evaluateAll((buttons) => buttons.forEach((button) => button.click()));
    await dropEntry(lab, entry);
    const holds = (said) => (typeof sentence === 'string' ? said.includes(sentence) : sentence.test(said));
    await until(async () => holds(await lab.text('notices')), async () => `a notice ${sentence} in "${(await lab.text('notices')).slice(0, 300)}"`);
    assert.equal(lab.last.case.toml, toml);
  }
  // Names that lead out of the folder are names of no file of a run.
  const outside = { name: 'inputs', inner: ['../../etc/passwd', '..', '/etc/passwd', 'a\\..\\b', 'CON', ''].map((name) => ({ name, bytes: text('x') })) };
  await lab.after(() => dropEntry(lab, { ...including(outside, { name: 'notes', inner: [] }), name: 'outside' }), 'recorded');
  assert.equal(lab.last.case.name, 'outside');
  // Fields of a TiB are left out, and are not read.
  await lab.after(() => dropEntry(lab, { ...instead('fields.nc', { size: 2 ** 40 }), name: 'sparse' }), 'case', ({ name }) => name === 'sparse');
  await lab.notice('The fields of sparse are left out');
});

/** Drops a file on the page. */
const dropFile = (lab, name, bytes) => lab.page.evaluate(([named, base64]) => {
  const event = new Event('drop', { bubbles: true, cancelable: true });
  const file = new File([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], named);
  Object.defineProperty(event, 'dataTransfer', { value: { items: [{ webkitGetAsEntry: () => ({ isDirectory: false }) }], files: [file] } });
  document.body.dispatchEvent(event);
}, [name, Buffer.from(bytes).toString('base64')]);

test('the file of a run that the page has saved is replayed when it is dropped, and so is one that was packed anew', withoutServer, async (t) => {
  const lab = await open(t, { toml: `${SMALL}\n[output]\nsnapshots = [20, 60]\n` });
  await lab.press('open-keep');
  await lab.find('#save-name').fill('kept');
  const { name, contents } = await lab.download(() => lab.press('save'));
  const { times_star: times } = await lab.after(() => dropFile(lab, name, contents), 'recorded');
  assert.deepEqual([times, lab.last.case.name], [[20, 60], 'kept']);
  const file = path.join(WORK, name);
  writeFileSync(file, contents);
  const repack = 'import sys, zipfile\nwith zipfile.ZipFile(sys.argv[1]) as a, zipfile.ZipFile(sys.argv[2], "w", zipfile.ZIP_DEFLATED) as b:\n'
    + '    for name in a.namelist(): b.writestr("folder/" + name, a.read(name))';
  execFileSync('python3', ['-c', repack, file, `${file}.zip`]);
  await lab.after(() => dropFile(lab, 'again.zip', readFileSync(`${file}.zip`)), 'recorded');
  assert.equal(lab.last.case.name, 'again');
  await until(() => lab.last.curve?.recorded_t?.length > 0, 'the recorded curve');
});

test('a case that the page has kept is opened when it is dropped', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const png = readFileSync(path.join(ROOT, 'crates/slipfront-lab/cases/gear.png'));
  await lab.after(() => lab.find('#image-file').setInputFiles({ name: 'gear.png', mimeType: 'image/png', buffer: png }), 'case', ({ texture }) => texture[0].shape === 'mask');
  const { toml } = lab.last.case;
  await lab.press('open-keep');
  const { contents } = await lab.download(() => lab.press('download-case'));
  await lab.after(() => dropFile(lab, 'plain.toml', Buffer.from(SMALL)), 'case', ({ name }) => name === 'plain');
  await lab.after(() => dropFile(lab, 'masked.zip', contents), 'case', ({ name }) => name === 'masked');
  assert.equal(lab.last.case.toml, toml);
});

test('a dropped file that can be no image, case, run or record is refused in a sentence, whatever size it claims', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const { toml } = lab.last.case;
  const png = (width, height) => {
    const bytes = Buffer.from('89504e470d0a1a0a0000000d49484452000000000000000008000000000000000000000000', 'hex');
    bytes.writeUInt32BE(width, 16);
    bytes.writeUInt32BE(height, 20);
    return [...bytes];
  };
  const zip = Buffer.alloc(64);
  // A header of a file of 4 GiB.
  zip.write('504b03041400000008000000000000000000', 0, 'hex');
  zip.fill(0xff, 18, 26);
  // The list of files of an archive that claims one file of 4 GiB, packed and not.
  const bomb = (method) => {
    const bytes = Buffer.alloc(46 + 9 + 22);
    bytes.write('504b0102', 0, 'hex');
    bytes.writeUInt16LE(method, 10);
    bytes.fill(0xff, 20, 28);
    bytes.writeUInt16LE(9, 28);
    bytes.write('case.toml', 46);
    bytes.write('504b0506', 55, 'hex');
    bytes.writeUInt16LE(1, 65);
    bytes.writeUInt32LE(55, 67);
    return [...bytes];
  };
  for (const [name, bytes] of Object.entries({
    'run.zip': [...zip], 'empty.zip': [], 'wide.png': png(2 ** 31 - 1, 1), 'large.png': png(100_000, 100_000), 'none.png': png(0, 0),
    'nested.svg': [...Buffer.from(`<svg xmlns="http://www.w3.org/2000/svg">${'<g>'.repeat(10_000)}`)],
  })) {
    await lab.find('#notices button').evaluateAll((buttons) => buttons.forEach((button) => button.click()));
    await dropFile(lab, name, bytes);
    await lab.notice(say(name.endsWith('.zip') ? 'file_unreadable' : 'image_unreadable', { name }));
  }
  for (const method of [0, 8]) {
    await dropFile(lab, `bomb${method}.zip`, bomb(method));
    await until(async () => /The case bomb\d has more than the [\d.]+ MiB/.test(await lab.text('notices')), 'a notice that it is too large');
  }
  // Whatever is no picture by its name may be a record.
  const { curve, problem } = await lab.after(() => dropFile(lab, 'text.md', [1, 2, 3]), 'record');
  assert.equal(curve, null);
  await lab.reads('measure-problem', problem);
  await lab.page.keyboard.press('Escape');
  assert.equal(lab.last.case.toml, toml);
  await lab.runToEnd();
});
