// The search for a texture that is better than the painted one: what is told of it, and that its result is
// one step of undo.
import assert from 'node:assert/strict';
import test from 'node:test';
import { open, PLAIN, say, SMALL, until } from './page.mjs';

/** What a number reads like on the page. */
const shown = (value) => value.toFixed(2).replace('-', '\u2212');
const estimate = ({ mean, half_width: half }) => `${shown(mean)} \u00b1 ${shown(half)}`;

test('a search shows its best, and once it is stopped replaces what is painted; undo brings that back', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const { toml, texture_percent: percent } = lab.last.case;
  await lab.reads('find-limits', say('find_limits', { percent: percent.toFixed(1), blocks: 3, width: '3 \u00b5m' }));
  const field = () => lab.find('#frame').screenshot();
  const before = await field();
  await lab.after(() => lab.press('find'), 'finding', ({ best_percent: best }) => best !== null);
  await lab.reads('find', say('find_stop'));
  await until(() => lab.find('#find-progress').isVisible(), 'how much of the time is over');
  await lab.reads('found', /^\d+ textures tried in \d+ of 60 s\. The best so far, orange in the field: \u2212\d/);
  await until(async () => !(await field()).equals(before), 'the best in the field');
  const found = await lab.after(() => lab.press('find'), 'found');
  assert.equal(found.outcome, 'replaced');
  assert.ok(found.best.mean < found.painted.mean && found.textures > 10);
  await lab.reads('found', say('found_replaced', { best: estimate(found.best), painted: estimate(found.painted), on: say('found_fresh', { surfaces: found.surfaces }) }));
  await lab.reads('find', say('find'));
  assert.equal(await lab.find('#find-progress').isVisible(), false);
  assert.ok(lab.last.case.texture[0].shape === 'mask' && lab.last.case.texture_percent <= percent);
  await lab.after(() => lab.press('undo'), 'case', (back) => back.toml === toml);
  await lab.reads('found', '');
});

test('a search is given up when the case is changed, and refused where a minute is too short', async (t) => {
  const lab = await open(t, { toml: PLAIN });
  await lab.after(() => lab.press('find'), 'finding');
  await lab.find('#control-r_star').fill('0.4');
  await lab.after(() => lab.find('#control-r_star').press('Enter'), 'found', ({ outcome }) => outcome === 'given_up');
  await lab.notice(say('found_given_up'));
  await lab.reads('find', say('find'));
  await lab.find('#control-speed').fill('0.00001');
  await lab.after(() => lab.find('#control-speed').press('Enter'), 'case', ({ values }) => values.speed.star === 0.00001);
  const { sentence } = await lab.after(() => lab.press('find'), 'refused');
  await lab.notice(sentence);
  assert.match(sentence, /^the slider is too large for a search of a minute/);
});
