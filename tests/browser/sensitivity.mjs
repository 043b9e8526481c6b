// What a quantity does to static friction, told below its slider.
import assert from 'node:assert/strict';
import test from 'node:test';
import { open, say, SMALL, sleep, until } from './page.mjs';

/** Longer than the page waits before it asks. */
const A_WHILE_MS = 900;

const asked = (lab) => lab.sent.filter((order) => order.do === 'sensitivity').map(({ control }) => control);
const line = (id) => `control-${id}-sensitivity`;

test('a slider with the focus says what its quantity does to static friction, once for a case', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const slider = lab.find('#control-load-slider');
  const { values, percent } = await lab.after(() => slider.focus(), 'sensitivity', ({ control }) => control === 'load');
  assert.ok(values[0] === lab.last.case.values.load.si && values[1] !== values[0]);
  const shown = `${percent > 0 ? '+' : ''}${percent.toFixed(Math.abs(percent) < 0.1 ? 2 : 1).replace('-', '\u2212')} %`;
  const kilo = values.map((value) => Number((value / 1e3).toPrecision(3)));
  const range = say('sensitivity_range', { from: kilo[0], to: kilo[1], unit: 'kPa' });
  await lab.reads(line('load'), say('sensitivity', { name: say('control_load'), range, change: shown }));
  // It belongs to the slider for those who hear the page, too, and lies below it.
  assert.ok((await slider.getAttribute('aria-describedby')).split(' ').includes(line('load')));
  await lab.reads('announcements', await lab.text(line('load')));
  const [above, below] = [await slider.boundingBox(), await lab.find(`#${line('load')}`).boundingBox()];
  assert.ok(below.y >= above.y + above.height - 1 && below.y - above.y - above.height < 20);
  // The same is not asked twice.
  await lab.find('#control-r_star-slider').focus();
  await until(() => lab.last.sensitivity.control === 'r_star', 'the other slider');
  await slider.focus();
  await sleep(A_WHILE_MS);
  assert.deepEqual(asked(lab), ['load', 'r_star']);
  // Of another case it is.
  await lab.after(() => slider.press('PageUp'), 'case', ({ why }) => why === 'change');
  await lab.reads(line('r_star'), '');
  await until(() => asked(lab).length === 3, 'a question on the changed case');
  assert.equal(asked(lab)[2], 'load');
});

test('who points at a slider for a moment is told, and who passes or drags it asks nothing', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const middle = async (id) => {
    const { x, y, width, height } = await lab.find(`#control-${id}-slider`).boundingBox();
    return [x + width / 2, y + height / 2];
  };
  for (const id of ['speed', 'load', 'r_star', 'seed']) await lab.page.mouse.move(...await middle(id));
  await sleep(A_WHILE_MS);
  assert.deepEqual(asked(lab), []);
  const [x, y] = await middle('sigma');
  await lab.page.mouse.move(x, y);
  await lab.page.mouse.down();
  await lab.after(() => lab.page.mouse.move(x + 20, y, { steps: 4 }), 'case', ({ why }) => why === 'change');
  await sleep(A_WHILE_MS);
  assert.deepEqual(asked(lab), []);
  await lab.after(() => lab.page.mouse.up(), 'sensitivity', ({ control }) => control === 'sigma');
  const place = await middle('sigma');
  await lab.reads(line('sigma'), /\(.*\)$/);
  // What is told moves no slider that is pointed at.
  assert.deepEqual(await middle('sigma'), place);
  await lab.after(async () => lab.page.mouse.move(...await middle('omega_star')), 'sensitivity', ({ control }) => control === 'omega_star');
  assert.deepEqual(asked(lab), ['sigma', 'omega_star']);
  assert.equal(await lab.find('#notices .notice').count(), 0);
});
