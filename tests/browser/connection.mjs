// A page that is not seen, and one without a server.
import assert from 'node:assert/strict';
import test from 'node:test';
import { startLaboratory } from './command.mjs';
import { open, say, SMALL, until, untilSame } from './page.mjs';

/** Lets the page be hidden or seen, as another tab of the browser above it does. */
const setHidden = (lab, hidden) => lab.page.evaluate((value) => {
  Object.defineProperty(document, 'hidden', { configurable: true, get: () => value });
  document.dispatchEvent(new Event('visibilitychange'));
}, hidden);

test('a page that is not seen gets nothing', async (t) => {
  const lab = await open(t, { calm: false });
  await until(() => lab.last.numbers?.step > 3, 'a run that goes on');
  await setHidden(lab, true);
  await untilSame(() => lab.count, 'no message any more');
  const { step } = lab.last.numbers;
  await setHidden(lab, false);
  // It has not stood still because it had ended.
  await until(() => lab.last.numbers.step > step, 'a run that goes on again');
});

test('a page whose server has ended says so, and what to do when another one does not know it', async (t) => {
  const one = await startLaboratory();
  const lab = await open(t, { toml: SMALL, address: one.address });
  lab.alone = true;
  await one.stop();
  await lab.notice(say('lost'));
  const other = await startLaboratory('--port', new URL(one.address).port);
  t.after(other.stop);
  const tried = lab.sockets;
  await until(() => lab.sockets > tried, 'another try');
  await lab.notice('was this page opened by the address that it printed?');
  // The new one has another token.
  assert.equal(lab.count.hello, 1);
  // The address that is printed now opens the page again, in the same tab.
  await lab.page.goto('about:blank');
  delete lab.last.hello;
  await lab.page.goto(other.address);
  await until(() => lab.last.hello, 'a connection');
  await until(async () => (await lab.text('notices')).includes(say('lost')) === false, 'no notice of a lost connection');
});

test('a page that loses its connection connects again, and shows the case it had', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.find('#control-speed').fill('0.05');
  const { toml } = await lab.after(() => lab.find('#control-speed').press('Enter'), 'case');
  // What the server does not understand ends the connection.
  lab.alone = true;
  await lab.page.evaluate(async () => (await import('/connection.js')).send({ do: 'nothing' }));
  const shown = await until(() => lab.count.hello === 2 && lab.last.case?.why === 'open' && lab.last.case, 'a new connection');
  assert.equal(shown.toml, toml);
});
