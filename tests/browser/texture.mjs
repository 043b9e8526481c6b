// Texture by hand: brush, eraser, shapes and images; and that the friction which the page shows is the
// command's.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { PNG } from 'pngjs';
import { slipfront, WORK } from './command.mjs';
import { open, PLAIN, say, SMALL, until } from './page.mjs';

/** A gray image by its function of column and row, from the top. */
export function image(size, gray) {
  const png = new PNG({ width: size, height: size });
  for (let k = 0; k < size * size; k++) png.data.set([gray(k % size, Math.floor(k / size)), 0, 0, 255].map((value, channel) => (channel < 3 ? gray(k % size, Math.floor(k / size)) : value)), 4 * k);
  return PNG.sync.write(png);
}

/** The summary that `slipfront run` prints for a case of the page, a file or a zip with its files. */
async function summaryOf({ name, contents }) {
  const file = path.join(WORK, name);
  writeFileSync(file, contents);
  const folder = path.join(WORK, `${name}.unpacked`);
  if (name.endsWith('.zip')) execFileSync('python3', ['-m', 'zipfile', '-e', file, folder]);
  return JSON.parse(await slipfront('run', name.endsWith('.zip') ? path.join(folder, 'case.toml') : file, '--json', '--out', path.join(WORK, `${name}.run`)));
}

test('a cavity that is painted lowers static friction, to the number of the command', async (t) => {
  const lab = await open(t, { toml: PLAIN });
  const smooth = (await lab.runToEnd()).summary.static_friction_star;
  await lab.press('tool-brush');
  await lab.find('#brush-size').fill('3');
  // Three rows of ten blocks, and three blocks beyond each end.
  const painted = await lab.after(() => lab.drag([5.5, 10.5], [14.5, 10.5]), 'case', (shown) => shown.texture_percent === 100 * (3 * 10 + 2 * 3) / 400);
  await lab.reads('numbers', new RegExp(`${say('number_texture')}${painted.texture_percent.toFixed(1)} %`));
  assert.equal(painted.texture[0].shape, 'mask');
  const { summary } = await lab.runToEnd();
  assert.ok(summary.static_friction_star < smooth, `${summary.static_friction_star} is not below ${smooth}`);
  await lab.reads('headline', /^\u2212\d/);
  await lab.press('open-keep');
  const download = await lab.download(() => lab.press('download-case'));
  assert.match(download.name, /\.zip$/);
  const command = await summaryOf(download);
  assert.deepEqual(command.static_friction_star, summary.static_friction_star);
  await lab.reads('summary-values', new RegExp(`${say('summary_static').replace('*', '\\*')}${command.static_friction_star.toFixed(4)}`));
  await lab.reads('numbers', new RegExp(`^${say('number_static').replace('*', '\\*')}${command.static_friction_star.toFixed(3)}`));
});

test('the eraser brings blocks into contact again; a stroke is one step of undo', async (t) => {
  const lab = await open(t, { toml: PLAIN });
  const stroke = async (tool, points, holds) => {
    await lab.press(`tool-${tool}`);
    return lab.after(() => lab.drag(...points), 'case', holds);
  };
  // Of width 5 around ten middles of blocks: five columns of ten blocks, and eight blocks beyond each end;
  // then four of the ten.
  const percent = 100 * (5 * 10 + 2 * 8) / 400;
  await stroke('brush', [[5.5, 5.5], [5.5, 14.5]], (shown) => shown.texture_percent === percent);
  await stroke('eraser', [[5.5, 11.5], [5.5, 14.5]], (shown) => shown.texture_percent === percent - 100 * (5 * 4 + 2 * 8) / 400);
  await lab.after(() => lab.press('undo'), 'case', (shown) => shown.texture_percent === percent);
  await lab.after(() => lab.press('undo'), 'case', (shown) => shown.texture_percent === 0);
});

/** What is drawn with each tool, and where its middle is then told, in blocks; a groove has one coordinate alone. */
const TOOLS = { circle: {}, ellipse: { w: 0.5 }, polygon: { s: 2 }, groove: { shape: 'groove' }, array: { array: [3, 3] } };
const micrometres = (text) => Number(/^([-\d.]+) um$/.exec(text)[1]);

for (const [tool, keys] of Object.entries(TOOLS)) {
  test(`${tool}: placed, moved, sized and deleted`, async (t) => {
    const lab = await open(t, { toml: PLAIN });
    const only = (shown) => shown.texture.length === 1;
    const table = () => lab.last.case.texture[0];
    // Blocks have an edge of a micrometre; an offset is told from the middle of the slider.
    const place = () => (tool === 'groove' ? micrometres(table().offset) + 10 : micrometres(table().center[0]));
    await lab.press(`tool-${tool}`);
    // A click with the polygon is a corner.
    await lab.after(() => lab.drag([9, 11], ...(tool === 'polygon' ? [[11, 11]] : [])), 'case', only);
    for (const [key, value] of Object.entries(keys)) assert.deepEqual(table()[key], value);
    // A pointer stands on whole pixels, and a block has some twenty of them.
    const near = (value, expected) => assert.ok(Math.abs(value - expected) < 0.1, `${value} is not ${expected}`);
    near(place(), 9);
    assert.equal(await lab.find('#shape-remove').count(), 1);
    await lab.after(() => lab.drag([9, 11], [12, 11]), 'case', () => Math.abs(place() - 12) < 0.1);
    const { coverage } = table();
    const [outline] = lab.last.case.shapes[0].outlines;
    const [xs, ys] = [0, 1].map((axis) => outline.map((point) => point[axis]));
    const grip = [Math.max(...xs), tool === 'groove' ? 10 : Math.max(...ys)];
    const outward = [grip[0] + 1.5, tool === 'groove' ? 10 : grip[1] + 1.5];
    // Of the answers to a drag the one to its last point is waited for.
    const answered = (k) => lab.last.case.texture[k].coverage === lab.sent.findLast((order) => order.do === 'set').keys.texture[k].coverage;
    await lab.after(() => lab.drag(grip, outward), 'case', () => table().coverage > 1.2 * coverage && answered(0));
    await lab.find('#shape-coverage').fill('7.5');
    await lab.after(() => lab.find('#shape-coverage').press('Enter'), 'case', () => table().coverage === 7.5);
    await lab.after(() => lab.press('shape-remove'), 'case', ({ texture }) => texture.length === 0);
    await lab.after(() => lab.press('undo'), 'case', only);
    // With a drag the radius is given.
    await lab.press(`tool-${tool}`);
    await lab.after(() => lab.drag([5, 5], [5, 8]), 'case', ({ texture }) => texture.length === 2 && answered(1));
    assert.notEqual(lab.last.case.texture[1].coverage, coverage);
  });
}

test('the corners of a polygon are clicked, and the first one closes it', async (t) => {
  const lab = await open(t, { toml: PLAIN });
  await lab.press('tool-polygon');
  const corners = [[4, 4], [14, 4], [9, 14]];
  for (const corner of corners) {
    assert.ok(await lab.find('#polygon-close').isDisabled());
    await lab.drag(corner);
  }
  const closed = await lab.after(() => lab.drag(corners[0]), 'case', ({ texture }) => texture.length === 1);
  assert.equal(closed.texture[0].shape, 'polygon');
  const points = closed.texture[0].points.map((point) => point.map(micrometres));
  // A pointer stands on whole pixels, and a block has some twenty of them.
  points.flat().forEach((value, k) => assert.ok(Math.abs(value - corners.flat()[k]) < 0.1, `${points}`));
  // Half of its box of 10 by 10 blocks of 400.
  assert.ok(Math.abs(closed.texture_percent - 12.5) < 2.5, `${closed.texture_percent} %`);
  // Corners are given up by Escape and by another tool.
  const { count } = lab;
  const before = count.case;
  await lab.press('tool-polygon');
  for (const corner of corners) await lab.drag([corner[0] + 3, corner[1] + 3]);
  await lab.find('#frame').press('Escape');
  assert.ok(await lab.find('#polygon-close').isDisabled());
  for (const corner of corners) await lab.drag([corner[0] + 3, corner[1] + 3]);
  await lab.press('tool-brush');
  await lab.press('tool-polygon');
  assert.ok(await lab.find('#polygon-close').isDisabled());
  assert.equal(count.case, before);
});

test('blocks that are too coarse for a shape are told beside the shapes, as long as they are', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.reads('too-coarse', '');
  await lab.find('#shapes button').click();
  const set = async (coverage) => {
    await lab.find('#shape-coverage').fill(coverage);
    await lab.after(() => lab.find('#shape-coverage').press('Enter'), 'case', ({ texture }) => texture[0].coverage === Number(coverage));
  };
  await set('1');
  await lab.reads('too-coarse', /^the smallest dimple is 2\.257 blocks across; the outline needs 5, at least 45 x 45 blocks /);
  await lab.reads('notices', '');
  await set('10');
  await lab.reads('too-coarse', '');
});

test('a number that is typed after Tab takes the place of the one there, also when the answer came between', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.find('#shapes button').click();
  await lab.find('#shape-coverage').fill('7.5');
  await lab.after(() => lab.page.keyboard.press('Tab'), 'case', ({ texture }) => texture[0].coverage === 7.5);
  await until(async () => (await lab.text('shapes')).includes('7.5 %'), 'the new coverage in the list');
  assert.equal(await lab.page.evaluate(() => document.activeElement.id), 'shape-x');
  await lab.after(async () => {
    await lab.page.keyboard.type('12');
    await lab.page.keyboard.press('Enter');
  }, 'case', ({ texture }) => micrometres(texture[0].center[0]) === 12);
});

test('what is painted is a layer of its own: shapes stay, and can be moved', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const { texture_percent: cavity } = lab.last.case;
  await lab.press('tool-brush');
  await lab.find('#brush-size').fill('3');
  // Away from the cavity: three rows of eight blocks, and three blocks beyond each end.
  const stroke = 100 * (3 * 8 + 2 * 3) / 400;
  const painted = await lab.after(() => lab.drag([5.5, 2.5], [12.5, 2.5]), 'case', (shown) => shown.texture_percent === cavity + stroke);
  assert.deepEqual(painted.texture.map(({ shape }) => shape), ['cavity', 'mask']);
  await lab.press('tool-probe');
  const moved = await lab.after(() => lab.drag([10, 10], [10, 13]), 'case', ({ texture }) => texture[0].center && Math.abs(micrometres(texture[0].center[1]) - 13) < 0.1);
  // The strokes stay where they are.
  assert.deepEqual(moved.texture.map(({ shape }) => shape), ['cavity', 'mask']);
  assert.ok(Math.abs(moved.texture_percent - cavity - stroke) <= 1, `${moved.texture_percent} %`);
  await lab.press('tool-eraser');
  const erased = await lab.after(() => lab.drag([5.5, 2.5], [12.5, 2.5]), 'case', ({ texture }) => texture.length === 1);
  assert.equal(erased.texture[0].shape, 'cavity');
  // Within a shape nothing but a mask can take blocks away.
  const cut = await lab.after(() => lab.drag([10, 13]), 'case', ({ texture }) => texture.length === 1 && texture[0].shape === 'mask');
  assert.ok(cut.texture_percent > 0 && cut.texture_percent < erased.texture_percent);
});

test('a shape is seen in its true form while it is dragged, as one step of undo', async (t) => {
  const lab = await open(t, { toml: PLAIN });
  await lab.press('tool-ellipse');
  const [from, to] = await Promise.all([[10, 10], [10, 14]].map((point) => lab.at(point)));
  await lab.page.mouse.move(...from);
  await lab.page.mouse.down();
  const dragged = await lab.after(() => lab.page.mouse.move(...to, { steps: 4 }), 'case', ({ shapes }) => shapes.length === 1);
  const [xs, ys] = [0, 1].map((axis) => dragged.shapes[0].outlines[0].map((point) => point[axis]));
  const [wide, high] = [xs, ys].map((places) => Math.max(...places) - Math.min(...places));
  assert.ok(wide > 2 * high, `${wide} by ${high} blocks is no ellipse`);
  await lab.page.mouse.up();
  assert.equal(await lab.find('#shape-remove').count(), 1);
  await lab.after(() => lab.press('undo'), 'case', ({ texture }) => texture.length === 0);
  await until(() => lab.find('#undo').isDisabled(), 'nothing more to undo');
});

test('an image keeps no more pixels than the slider has blocks', async (t) => {
  const lab = await open(t, { toml: PLAIN });
  const shown = await lab.after(() => lab.find('#image-file').setInputFiles({ name: 'large.png', mimeType: 'image/png', buffer: image(1000, (x, y) => (x < 500 && y < 250 ? 0 : 255)) }), 'case', ({ texture }) => texture.length === 1);
  assert.equal(shown.texture_percent, 12.5);
  await lab.press('open-keep');
  const { name, contents } = await lab.download(() => lab.press('download-case'));
  const folder = path.join(WORK, 'large');
  writeFileSync(path.join(WORK, name), contents);
  execFileSync('python3', ['-m', 'zipfile', '-e', path.join(WORK, name), folder]);
  const { width, height } = PNG.sync.read(readFileSync(path.join(folder, shown.texture[0].file)));
  assert.deepEqual([width, height], [20, 20]);
});

test('an image becomes the texture, chosen as a file and dropped', async (t) => {
  const lab = await open(t, { toml: PLAIN });
  const half = image(20, (x) => (x < 10 ? 0 : 255));
  const [chooser] = await Promise.all([lab.page.waitForEvent('filechooser'), lab.press('tool-image')]);
  await lab.after(() => chooser.setFiles({ name: 'half.png', mimeType: 'image/png', buffer: half }), 'case', (shown) => shown.texture_percent === 50);
  const quarter = image(20, (x, y) => (x < 10 && y < 10 ? 0 : 255));
  await lab.after(() => lab.page.evaluate((bytes) => {
    const data = new DataTransfer();
    data.items.add(new File([new Uint8Array(bytes)], 'quarter.png', { type: 'image/png' }));
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
  }, [...quarter]), 'case', (shown) => shown.texture_percent === 25);
  // Dark in the image is texture at the same place: left and above.
  await lab.after(async () => lab.page.mouse.move(...(await lab.at([4.5, 15.5]))), 'probe', ({ textured }) => textured);
  await lab.after(async () => lab.page.mouse.move(...(await lab.at([4.5, 4.5]))), 'probe', ({ textured }) => !textured);
  await lab.find('#image-file').setInputFiles({ name: 'notes.txt', mimeType: 'text/plain', buffer: Buffer.from('no image') });
  await lab.notice(say('image_unreadable', { name: 'notes.txt' }));
});
