// The first picture, and what the page loads for it.
import assert from 'node:assert/strict';
import test from 'node:test';
import { deflateRawSync } from 'node:zlib';
import { browser, colours, IS_ALONE, Lab, laboratory, onServer, open, say, until, webJson } from './page.mjs';

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

test('a token that is none is refused with a sentence', onServer, async (t) => {
  const lab = await open(t, {});
  const address = lab.address.replace(/#.*/, '#token=<script>alert(1)</script>');
  // The tab has a token already, with which it goes on.
  await lab.page.goto('about:blank');
  await lab.after(() => lab.page.goto(address), 'hello');
  await lab.notice(say('broken_token'));
  assert.doesNotMatch(lab.page.url(), /token/);
  // Another one has none.
  const context = await browser.newContext();
  t.after(() => context.close());
  const other = new Lab(await context.newPage(), address);
  other.alone = true;
  await other.load(address);
  await other.notice(say('broken_token'));
  await other.notice(say('lost'));
  assert.deepEqual(other.faults, []);
});

test('the page has no error when a case that is unpacked is none', async (t) => {
  const lab = await open(t, {});
  const packed = (content) => deflateRawSync(JSON.stringify(content)).toString('base64url');
  for (const content of [{ toml: 1 }, { toml: '', name: {} }, { toml: '', files: { a: 1 } }, { toml: ' '.repeat(9e6) }, null]) {
    await lab.page.evaluate((text) => (location.hash = `#case=${text}`), packed(content));
    await lab.notice('cannot be read');
    await lab.find('#notices button').evaluateAll((buttons) => buttons.forEach((button) => button.click()));
  }
  assert.equal(lab.sockets, IS_ALONE ? 0 : 1);
});

test('an address opens a case of the list by its name, and says when there is none', async (t) => {
  const lab = await open(t, {});
  await lab.after(() => lab.page.evaluate(() => (location.hash = '#preset=groove_across')), 'case', ({ name }) => name === 'groove_across');
  await lab.after(() => lab.page.evaluate(() => (location.hash = '#preset=none')), 'case', ({ name }) => name !== 'groove_across');
  await lab.notice(say('broken_link'));
  // From its beginning on.
  const address = IS_ALONE ? `${lab.address}preset=groove_along` : `${lab.address}&preset=groove_along`;
  const other = await open(t, { address });
  await other.reads('case-name', 'groove_along');
});

test('an address opens a case, a lesson and a field', async (t) => {
  const open_ = (hash) => open(t, { address: `${laboratory.address}${IS_ALONE ? '' : '&'}${hash}` });
  const lab = await open_('case=gear&field=first_slip');
  await lab.reads('case-name', 'gear');
  assert.equal(lab.last.picture.field, 5);
  assert.equal(await lab.find('#field').inputValue(), 'first_slip');
  await lab.after(() => lab.page.evaluate(() => (location.hash = '#field=speed')), 'picture', ({ field }) => field === 3);
  assert.equal(lab.last.case.name, 'gear');
  const [, { id }] = await webJson('lessons.json');
  const { title } = (await webJson('lessons.en.json'))[id];
  for (const wanted of ['2', id]) {
    const lesson = await open_(`lesson=${wanted}`);
    await lesson.reads('lesson-title', title);
  }
  await lab.after(() => lab.page.evaluate(() => (location.hash = '#lesson=99')), 'case', ({ name }) => name === 'circle');
  await lab.notice(say('broken_link'));
});

test('the page has no error when a case of the address is broken, and says so', async (t) => {
  const lab = await open(t, {});
  await lab.page.evaluate(() => (location.hash = '#case=broken'));
  await lab.notice('cannot be read');
});

test('the opening slider changes friction by what its description says', async (t) => {
  const lab = await open(t, {});
  const { title } = lab.last.hello.presets.find(({ name }) => name === lab.last.case.name);
  const { change_percent: change } = await lab.runToEnd();
  const [, percent] = /static friction falls by (\d+) %/.exec(title);
  assert.equal(Math.round(-change), Number(percent));
});
