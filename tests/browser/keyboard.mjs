// The page by keyboard alone: Tab, arrows, Enter and Space, from its first moment.
import assert from 'node:assert/strict';
import test from 'node:test';
import { open, PLAIN, SMALL, until } from './page.mjs';

/** More than the page has places to stop at. */
const MOST_STOPS = 120;

/** Goes on with Tab until the element has the focus; at every stop the focus is seen. */
async function tabTo(lab, id, key = 'Tab') {
  for (let stop = 0; stop < MOST_STOPS; stop++) {
    await lab.page.keyboard.press(key);
    const at = await lab.page.evaluate(() => {
      const element = document.activeElement;
      const { outlineStyle, outlineWidth } = getComputedStyle(element);
      const ring = outlineStyle !== 'none' && parseFloat(outlineWidth) >= 1;
      return { id: element.id, name: element.tagName, seen: ring || element === document.body };
    });
    assert.ok(at.seen, `the focus on ${at.name} #${at.id} is not seen`);
    if (at.id === id) return;
  }
  assert.fail(`#${id} is not reached by Tab`);
}

test('paint, change the speed, undo, open a case, read the help: by keyboard', async (t) => {
  const lab = await open(t, { toml: PLAIN });
  const press = (key) => lab.page.keyboard.press(key);
  await tabTo(lab, 'tool-brush');
  await press('Enter');
  await tabTo(lab, 'brush-size');
  await press('Home');
  await tabTo(lab, 'frame');
  for (const key of ['ArrowRight', 'ArrowUp', 'ArrowUp']) await press(key);
  // The cursor begins in the middle of 20 by 20 blocks. A brush of width 1 paints one of them.
  const probed = await until(() => lab.last.probe?.block.join() === '10,11' || lab.last.probe?.block.join() === '11,12' ? lab.last.probe : null, () => `a probe of the block at the cursor; it is ${lab.last.probe?.block}`);
  const painted = await lab.after(() => press('Space'), 'case', (shown) => shown.texture_percent === 0.25);
  assert.equal(painted.texture[0].shape, 'mask');
  await until(() => lab.last.probe.textured && lab.last.probe.block.join() === probed.block.join(), 'the block below the cursor is textured');
  await tabTo(lab, 'control-speed-slider');
  const { star } = lab.last.case.values.speed;
  const faster = await lab.after(() => press('ArrowRight'), 'case');
  assert.ok(faster.values.speed.star > star);
  await tabTo(lab, 'undo', 'Shift+Tab');
  assert.equal((await lab.after(() => press('Enter'), 'case')).values.speed.star, star);
  await lab.after(() => press('Enter'), 'case', (shown) => shown.texture_percent === 0);
  await tabTo(lab, 'open-presets', 'Shift+Tab');
  await press('Enter');
  await until(() => lab.find('#presets-search:focus').count(), 'the search has the focus');
  await lab.page.keyboard.type('damped');
  assert.equal((await lab.after(() => press('Enter'), 'case')).name, 'damped');
  await until(() => lab.find('#open-presets:focus').count(), 'the button has the focus again');
  await tabTo(lab, 'open-help');
  await press('Enter');
  await until(() => lab.find('#help').isVisible(), 'the help');
  await press('Escape');
  await until(async () => !(await lab.find('#help').isVisible()), 'no help');
  await until(() => lab.find('#open-help:focus').count(), 'the button has the focus again');
  await press('?');
  await until(() => lab.find('#help').isVisible(), 'the help by its key');
  await press('Escape');
});

test('a shape is placed, moved, sized, turned and deleted by keyboard', async (t) => {
  const lab = await open(t, { toml: PLAIN });
  const frame = lab.find('#frame');
  const table = () => lab.last.case.texture[0];
  await frame.focus();
  const press = (key, holds) => lab.after(() => lab.page.keyboard.press(key), 'case', holds);
  await lab.page.keyboard.press('5');
  await press('Enter', ({ texture }) => texture.length === 1);
  const { center: [x], coverage } = table();
  await press('Control+ArrowRight', () => parseFloat(table().center[0]) === parseFloat(x) + 1);
  await press(']', () => table().coverage > coverage);
  await press(',', () => table().rotate === 5);
  await press('Delete', ({ texture }) => texture.length === 0);
});

test('the cursor begins at a block that the tool changes, and a polygon is closed by a key', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const frame = lab.find('#frame');
  await frame.focus();
  // The middle of the slider is a hole, which the brush does not change.
  await lab.page.keyboard.press('2');
  const { texture_percent: percent } = lab.last.case;
  await lab.after(() => lab.page.keyboard.press('Enter'), 'case', (shown) => shown.texture_percent > percent);
  await lab.page.keyboard.press('Escape');
  await lab.page.keyboard.press('3');
  await lab.after(() => lab.page.keyboard.press('Enter'), 'case', (shown) => shown.texture_percent < percent);
  await lab.page.keyboard.press('6');
  for (const [arrow, steps] of [['ArrowLeft', 4], ['ArrowDown', 6], ['ArrowRight', 8]]) {
    for (let k = 0; k < steps; k += 1) await lab.page.keyboard.press(arrow);
    await lab.page.keyboard.press('Enter');
  }
  await lab.after(() => lab.page.keyboard.press('c'), 'case', ({ texture }) => texture.at(-1).shape === 'polygon');
  assert.equal(lab.last.case.texture.at(-1).points.length, 3);
});
