// A run folder again, beside what it recorded.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
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
