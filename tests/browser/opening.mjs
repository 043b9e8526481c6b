// The first picture, and what the page loads for it.
import assert from 'node:assert/strict';
import test from 'node:test';
import { colours, open, until } from './page.mjs';

test('the page opens with a slider that runs, and draws it', async (t) => {
  const begin = performance.now();
  const lab = await open(t, { calm: false });
  // A time depends on what else the machine does: it is told and not judged.
  t.diagnostic(`first picture after ${((performance.now() - begin) / 1000).toFixed(2)} s`);
  await until(() => lab.last.numbers?.step > 0, 'a step of the run');
  // A field of blocks in different states has the colours of a scale, not those of a frame around nothing.
  await until(async () => colours(await lab.find('#canvas').screenshot()) > 16, 'a field of more than 16 colours');
  assert.equal(await lab.find('html').getAttribute('lang'), 'en');
  assert.doesNotMatch(lab.page.url(), /token/);
});

test('the page has no error when a case of the address is broken, and says so', async (t) => {
  const lab = await open(t, {});
  await lab.page.evaluate(() => (location.hash = '#case=broken'));
  await lab.notice('cannot be read');
});
