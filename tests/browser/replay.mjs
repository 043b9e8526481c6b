// A run folder again, beside what it recorded.
import assert from 'node:assert/strict';
import { copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { RESULTS, slipfront, WORK } from './command.mjs';
import { onServer, open, say, SMALL, until } from './page.mjs';

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

/** Drops a folder on the page: its files, and one of its folders. */
const drop = (lab, folder) => {
  const files = (of) => readdirSync(of, { withFileTypes: true }).map((entry) => (entry.isDirectory() ? { name: entry.name, inner: files(path.join(of, entry.name)) } : { name: entry.name, bytes: [...readFileSync(path.join(of, entry.name))] }));
  return lab.page.evaluate(({ name, inner }) => {
    const entryOf = ({ name, inner, bytes }) => ({
      name,
      isFile: !inner,
      isDirectory: Boolean(inner),
      file: (take) => take(new File([new Uint8Array(bytes)], name)),
      createReader: () => {
        let left = inner.map(entryOf);
        return { readEntries: (take) => take(left.splice(0, 2)) };
      },
    });
    const event = new Event('drop', { bubbles: true, cancelable: true });
    Object.defineProperty(event, 'dataTransfer', { value: { items: [{ webkitGetAsEntry: () => entryOf({ name, inner }) }], files: [] } });
    document.body.dispatchEvent(event);
  }, { name: path.basename(folder), inner: files(folder) });
};

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
