// Every control: what the reader sets is what the server tells back, and what the page then shows.
import assert from 'node:assert/strict';
import test from 'node:test';
import { colours, open, PLAIN, say, SMALL, sleep, until, untilSame } from './page.mjs';

/** Between a number that was set and the one told lie conversions of units: a few roundings of a double. */
const ROUNDING = 1e-12;
const near = (value, expected) => assert.ok(Math.abs(value - expected) <= ROUNDING * Math.abs(expected), `${value} is not ${expected}`);

/** A value inside the range of a control, which no case here has. */
function another({ min, max, logarithmic, whole }) {
  const value = logarithmic ? min * (max / min) ** 0.63 : min + (max - min) * 0.63;
  return whole ? Math.round(value) : Number(value.toPrecision(2));
}

test('sliders and number fields change the case, undo and redo take it back and forth', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const original = lab.last.case.toml;
  assert.equal(lab.last.hello.controls.length, await lab.find('#controls .control').count());
  for (const control of lab.last.hello.controls) {
    const { id, key, si_key: siKey } = control;
    const form = key === siKey ? 'si' : 'star';
    const [field, slider] = [lab.find(`#control-${id}`), lab.find(`#control-${id}-slider`)];
    const before = lab.last.case.values[id][form];
    const moved = await lab.after(() => slider.press(before === control.max ? 'PageDown' : 'PageUp'), 'case');
    assert.ok(before === control.max ? moved.values[id][form] < before : moved.values[id][form] > before, `${id} by the keyboard: ${moved.values[id][form]} from ${before}`);
    const value = another(control);
    await field.fill(String(value));
    const set = await lab.after(() => field.press('Enter'), 'case');
    near(set.values[id][form], value);
    assert.notEqual(set.toml, moved.toml);
    await until(async () => Number(await field.inputValue()) === value, `${id} shows ${value}`);
    // The other form of the value, in a prefix of SI: its digits, rounded to the three that are shown.
    const other = set.values[id][form === 'si' ? 'star' : 'si'];
    if (other !== null) {
      const digits = Number(other.toPrecision(3)).toExponential().replace(/e.*|\./g, '');
      const shown = await lab.text(`control-${id}-other`);
      assert.match(shown.replace(/[^\d]|e.*/g, '').replace(/^0+|0+$/g, ''), new RegExp(`^${digits.replace(/0+$/, '')}`), `${id}: ${other} is shown as ${shown}`);
    }
    // A value that is none leaves the case and the field as they were.
    await field.fill('much');
    await field.press('Enter');
    await until(async () => Number(await field.inputValue()) === value, `${id} shows ${value} again`);
    for (const toml of [moved.toml, original]) assert.equal((await lab.after(() => lab.press('undo'), 'case')).toml, toml);
    for (const toml of [moved.toml, set.toml]) assert.equal((await lab.after(() => lab.press('redo'), 'case')).toml, toml);
    for (const toml of [moved.toml, original]) assert.equal((await lab.after(() => lab.page.keyboard.press('Control+z'), 'case')).toml, toml);
  }
  await until(() => lab.find('#undo').isDisabled(), 'nothing to undo');
});

test('a value out of bounds is refused in a sentence, and the case stays', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const { toml } = lab.last.case;
  await lab.find('#control-r_star').fill('-1');
  const { sentence } = await lab.after(() => lab.find('#control-r_star').press('Enter'), 'refused');
  await lab.notice(sentence.split('\n')[0]);
  assert.equal(lab.last.case.toml, toml);
  await until(async () => (await lab.find('#control-r_star').inputValue()) === '0.5', 'the value that holds');
  await lab.find('#notices button').click();
  await lab.reads('notices', '');
});

test('typing replaces a number that was put back', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.find('#control-r_star').fill('-1');
  await lab.after(() => lab.find('#control-r_star').press('Enter'), 'refused');
  await until(async () => (await lab.find('#control-r_star').inputValue()) === '0.5', 'the value that holds');
  await lab.after(async () => {
    await lab.page.keyboard.type('0.4');
    await lab.page.keyboard.press('Enter');
  }, 'case', ({ values }) => values.r_star.star === 0.4);
});

test('the run goes on, stops, takes single steps and begins from rest', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const stepIs = (step) => until(() => lab.last.numbers?.step === step, () => `step ${step}; it is ${lab.last.numbers?.step}`);
  await lab.reads('pause', say('play'));
  for (const step of [1, 2]) {
    await lab.press('step');
    await stepIs(step);
  }
  await lab.find('#frame').press('n');
  await stepIs(3);
  await lab.press('rest');
  await until(() => lab.last.case.why === 'rest', 'the case from rest');
  await stepIs(0);
  await lab.press('pause');
  await until(() => lab.last.numbers.step > 3, 'steps of a run that goes on');
  await lab.find('#frame').press(' ');
  await lab.reads('pause', say('play'));
  await untilSame(() => lab.last.numbers.step, 'a run that stands still');
  // It has stopped, and not ended.
  const { step } = lab.last.numbers;
  await lab.press('step');
  await stepIs(step + 1);
  const { pace } = lab.sent.findLast((order) => order.pace);
  await lab.find('#pace').press('ArrowRight');
  await until(() => lab.sent.at(-1).pace > pace, 'a faster pace');
  await lab.reads('pace-value', /t\* per s/);
});

test('a change begins a leg when the run goes on after it, and starts from rest when not', async (t) => {
  const lab = await open(t, { toml: PLAIN });
  const change = (value) => lab.after(() => lab.find('#control-speed').fill(value).then(() => lab.find('#control-speed').press('Enter')), 'case');
  await lab.press('pause');
  await until(() => lab.last.numbers?.t_star > 5, 'some time of the first leg');
  await lab.press('after-go-on');
  await lab.reads('effect', say('effect_go_on'));
  const curve = lab.count.curve;
  assert.equal((await change('0.06')).leg, 1);
  const leg = await until(() => lab.count.curve > curve && lab.last.curve.leg === 1 && lab.last.curve.t.length > 0 && lab.last.curve, 'points of the second leg');
  assert.ok(leg.t[0] > 5 && !leg.from_rest);
  assert.equal((await change('0.09')).leg, 2);
  assert.ok(lab.last.case.time_before_s > 0);
  await lab.reads('headline-note', new RegExp(`${say('not_from_rest')}|${say('preliminary')}|${say('certain')}`));
  // Each beginning of a leg is a line over the whole height of the plot.
  await lab.press('pause');
  await sleep(300);
  const with2 = await lab.find('#plot-mu').screenshot();
  await lab.press('after-rest');
  const rest = await change('0.03');
  assert.deepEqual([rest.leg, rest.time_before_s], [0, 0]);
  await until(async () => !(await lab.find('#plot-mu').screenshot()).equals(with2), 'a curve that begins anew');
});

test('every field is shown with its name', async (t) => {
  // A run that does not end before it is stopped.
  const lab = await open(t, { toml: SMALL.replace('= 120', '= 400') });
  const fields = await lab.find('#field option').evaluateAll((options) => options.map(({ value }) => value));
  const { FIELDS } = await import('../../crates/slipfront-lab/web/frames.js');
  assert.deepEqual(fields.toSorted(), FIELDS.toSorted());
  await lab.press('pause');
  await until(() => lab.last.numbers?.t_star > 2, 'some time');
  await lab.press('pause');
  for (const [k, field] of FIELDS.entries()) {
    await lab.after(() => lab.find('#field').selectOption(field), 'picture', (picture) => picture.field === k);
    assert.equal(await lab.find('#legend-not-yet').isVisible(), ['first_slip', 'front'].includes(field));
    assert.equal(await lab.find('#legend-sliding').isVisible(), field === 'front');
  }
  await sleep(300);
  const viridis = await lab.find('#bar').screenshot();
  await lab.find('#colourmap').selectOption('cividis');
  await until(async () => !(await lab.find('#bar').screenshot()).equals(viridis), 'other colours');
});

test('the field is enlarged and moved, and all of it shown again', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const [x, y] = await lab.at([15.5, 15.5]);
  // What lies below one pixel tells how the field is seen.
  const below = async (what, i, j) => {
    await lab.page.mouse.move(x - 1, y);
    await lab.page.mouse.move(x, y);
    await until(async () => (await lab.text('probe-block')) === say('probe_block', { i, j }), async () => `block ${i}, ${j} after ${what}; it is ${await lab.text('probe-block')}`);
  };
  // The cavity in the middle of the field, where nothing lies above it.
  const [left, top] = await lab.at([6, 14]);
  const seen = () => lab.page.screenshot({ clip: { x: left, y: top, width: 150, height: 150 } });
  const all = await seen();
  await below('nothing', 15, 15);
  await lab.press('zoom-in');
  await below('enlarging', 13, 13);
  await until(async () => !(await seen()).equals(all), 'the picture is enlarged');
  await lab.page.keyboard.down('Shift');
  await lab.drag([10, 10], [13, 13]);
  await lab.page.keyboard.up('Shift');
  await below('moving by 3 blocks of 1.5 times their size', 11, 11);
  await lab.drag([3, 3], [0, 0]);
  await below('moving it back without Shift', 13, 13);
  await lab.press('zoom-out');
  await below('reducing', 15, 15);
  await lab.page.mouse.wheel(0, -1000);
  // The point below the pointer stays where it is.
  await below('the wheel', 15, 15);
  await until(async () => !(await seen()).equals(all), 'the wheel enlarges');
  await lab.press('zoom-all');
  await until(async () => (await seen()).equals(all), 'all of the slider again');
  await lab.find('#frame').press('+');
  await below('the plus key', 13, 13);
  await lab.find('#frame').press('0');
  await below('the key 0', 15, 15);
});

test('the probe reads the block below the pointer', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const point = async (at) => {
    const probe = await lab.after(async () => lab.page.mouse.move(...(await lab.at(at))), 'probe', ({ block }) => block[0] === Math.floor(at[0]) && block[1] === Math.floor(at[1]));
    await lab.reads('probe-block', say('probe_block', { i: probe.block[0], j: probe.block[1] }));
    return probe;
  };
  assert.equal((await point([10.5, 10.5])).textured, true);
  await lab.reads('probe-values', new RegExp(say('probe_textured')));
  const probe = await point([2.5, 17.5]);
  assert.equal(probe.textured, false);
  await lab.reads('probe-values', new RegExp(probe.mu_static.toFixed(3)));
});

test('the kymograph has a row for each instant that the server sends, and its colours go up to the largest share', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.runToEnd();
  await until(async () => (await lab.find('#kymograph').evaluate(({ width, height }) => `${width} ${height}`)) === `${lab.last.kymograph.bins} ${lab.last.kymograph.rows}`, 'a kymograph of the size that was sent');
  assert.ok(lab.last.kymograph.rows > 10 && lab.last.kymograph.bins > 1);
  assert.ok(colours(await lab.find('#kymograph').screenshot()) > 4);
  // The last colour of the map, which only the largest share has.
  const { COLOURMAPS } = await import('../../crates/slipfront-lab/web/colourmaps.js');
  const last = COLOURMAPS.viridis.slice(-6);
  const brightest = () => lab.find('#kymograph').evaluate((canvas, wanted) => {
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    return Array.from({ length: data.length / 4 }, (_, k) => [...data.subarray(4 * k, 4 * k + 3)].map((value) => value.toString(16).padStart(2, '0')).join('')).includes(wanted);
  }, last);
  await until(brightest, 'a place with the last colour');
});

test('cases are found by their words and opened', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.press('open-presets');
  const entries = lab.find('#presets-list button');
  // Each has a sentence and, but for recorded runs, a small picture of what it is.
  await until(() => lab.find('#presets-list canvas').count(), 'pictures');
  assert.equal(await entries.count(), lab.last.hello.presets.length + lab.last.hello.folders.length);
  assert.equal(await lab.find('#presets-list canvas').count(), lab.last.hello.presets.length);
  assert.ok(await lab.find('#presets-list canvas').evaluateAll((all) => all.every((canvas) => canvas.getContext('2d').getImageData(0, 0, 32, 32).data.some((value) => value > 0))));
  await lab.find('#presets-search').fill('groove ACROSS');
  const found = await entries.allTextContents();
  assert.ok(found.length > 0 && found.length < lab.last.hello.presets.length);
  for (const text of found) assert.match(text, /groove.*across|across.*groove/i);
  await lab.find('#presets-search').fill('no such case');
  await lab.reads('presets-list', say('nothing_found'));
  await lab.find('#presets-search').fill('groove_across');
  const opened = await lab.after(() => entries.first().click(), 'case');
  assert.deepEqual([opened.name, opened.why, opened.texture[0].shape], ['groove_across', 'open', 'groove']);
  await lab.reads('case-name', 'groove_across');
  assert.equal(await lab.find('#presets').isVisible(), false);
});

test('a case of the list says what it is, and a figure of many runs that it is one of them', async (t) => {
  const lab = await open(t, {});
  const go = (name) => lab.after(() => lab.page.evaluate((hash) => (location.hash = hash), `#preset=${name}`), 'case', (shown) => shown.why === 'open');
  const titleOf = (name) => lab.last.hello.presets.find((preset) => preset.name === name).title;
  await go('paper/fig16');
  await lab.notice(say('preset_study', { title: titleOf('paper/fig16') }));
  await go('gear');
  await lab.notice(say('preset_case', { title: titleOf('gear') }));
  assert.equal((await lab.text('notices')).includes(titleOf('paper/fig16')), false);
});

test('the theme is chosen, and remembered', async (t) => {
  const lab = await open(t, { toml: SMALL, colorScheme: 'light' });
  const background = () => lab.find('body').evaluate((body) => getComputedStyle(body).backgroundColor);
  const bright = await background();
  for (const theme of ['light', 'dark']) {
    await lab.press('theme');
    await lab.reads('theme', say(`theme_${theme}`));
    assert.equal((await background()) === bright, theme === 'light');
  }
  await lab.page.reload();
  await until(async () => (await lab.text('theme')) === say('theme_dark'), 'the theme of before');
  await lab.press('theme');
  await lab.reads('theme', say('theme_auto'));
  assert.equal(await background(), bright);
});

test('the help opens and closes, and lists every key', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.press('open-help');
  assert.ok(await lab.find('#help').isVisible());
  assert.ok((await lab.find('#shortcuts dt').count()) >= 16);
  await lab.find('#help .close').click();
  assert.equal(await lab.find('#help').isVisible(), false);
});

test('static friction over some seeds is counted up and told with its interval', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.find('#repeat-seeds').fill('2');
  await lab.press('repeat');
  const { change_percent: change } = await until(() => lab.last.repeated?.finished && lab.last.repeated, 'two seeds');
  await lab.reads('repeated', new RegExp(`^${change.mean.toFixed(1).replace('-', '\u2212')} \u00b1 ${change.half_width.toFixed(1)} %`));
});
