// What the page tells by itself: whither the drive pulls, what to try, that a run has ended and what it has found.
import assert from 'node:assert/strict';
import test from 'node:test';
import { open, PLAIN, say, SMALL, until } from './page.mjs';

test('an arrow tells whither the drive pulls, unless it turns the slider', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const arrow = lab.find('#drive svg');
  assert.equal(await arrow.evaluate((svg) => svg.style.transform), 'rotate(0deg)');
  await lab.find('#control-direction').fill('30');
  await lab.after(() => lab.find('#control-direction').press('Enter'), 'case', ({ drive_degrees: degrees }) => degrees === 30);
  await until(async () => (await arrow.evaluate((svg) => svg.style.transform)) === 'rotate(-30deg)', 'an arrow that points up to the right');
  const turned = await open(t, { toml: `${PLAIN}\n[drive]\nmotion = "rotation"\n` });
  assert.equal(turned.last.case.drive_degrees, null);
  assert.equal(await turned.find('#drive').isVisible(), false);
});

test('a run says what to try, and at its end what it has found and three ways on', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.reads('next-text', say('next_try_more'));
  assert.equal(await lab.find('#next-buttons').isVisible(), false);
  const { peak, change_percent: change } = await lab.runToEnd();
  await lab.reads('next-text', say('next_found_change', { mu: peak.mu_star.toFixed(3), change: `${change.toFixed(1).replace('-', '\u2212')} %` }));
  await lab.reads('pause', say('ended_button'));
  assert.ok(await lab.find('#pause').isDisabled());
  await lab.after(() => lab.press('next-repeat'), 'repeated');
  await lab.press('next-paint');
  assert.equal(await lab.find('#tool-brush').getAttribute('aria-pressed'), 'true');
  // Another run goes on again, slowly enough to be seen.
  await lab.find('#pace').press('Home');
  await lab.after(() => lab.press('rest'), 'case', ({ why }) => why === 'rest');
  await until(async () => (await lab.text('pause')) !== say('ended_button'), 'a run that can be stopped');
});

test('a number may have its unit, and what is none is said to be none', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.find('#control-load').fill('2 MPa');
  await lab.after(() => lab.find('#control-load').press('Enter'), 'case', ({ values }) => values.load.si === 2e6);
  const { toml } = lab.last.case;
  await lab.find('#control-load').fill('abc');
  await lab.find('#control-load').press('Enter');
  await lab.notice(say('not_a_number', { name: say('control_load'), text: 'abc', example: say('not_a_number_example', { unit: 'Pa' }) }));
  await until(async () => (await lab.find('#control-load').inputValue()) === '2000000', 'the value that holds');
  // A unit of something else is refused by the case.
  await lab.find('#control-load').fill('2 m/s');
  await lab.after(() => lab.find('#control-load').press('Enter'), 'refused');
  assert.equal(lab.last.case.toml, toml);
});

test('what a block has is told as long as the pointer is on the field', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const point = async () => lab.after(async () => lab.page.mouse.move(...(await lab.at([2.5, 17.5]))), 'probe');
  await point();
  await lab.find('#probe').waitFor();
  await lab.page.mouse.move(2, 2);
  await lab.find('#probe').waitFor({ state: 'hidden' });
  // The same block again.
  await point();
  await lab.find('#probe').waitFor();
});

test('the page prints without what can only be pressed', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.runToEnd();
  await lab.page.emulateMedia({ media: 'print' });
  for (const id of ['tools', 'open-keep', 'controls', 'next', 'zoom']) assert.equal(await lab.find(`#${id}`).isVisible(), false, id);
  for (const id of ['case-name', 'canvas', 'headline', 'numbers', 'plot-mu', 'kymograph']) assert.equal(await lab.find(`#${id}`).isVisible(), true, id);
  const pages = (await lab.page.pdf({ format: 'A4' })).toString('latin1').match(/\/Type\s*\/Page\b/g).length;
  assert.ok(pages <= 2, `${pages} sheets`);
});
