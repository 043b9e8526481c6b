// Measured records: drawn over the curve in the units of the case, shifted, calibrated, and what is done with
// the numbers. Nothing of it leaves the page, as `open` checks of every page.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { link, ROOT, slipfront, WORK } from './command.mjs';
import { colours, open, PLAIN, say, SMALL, until } from './page.mjs';

/** A slider that a calibration of some hundred runs takes seconds of. */
const TINY = `
[slider]
blocks = [8, 8]

[friction]
mu_static = 0.5

[time]
duration_star = 150
`;
/** What made the record of a calibration. */
const TRUTH = { 'friction.mu_static': 0.6, 'friction.r_star': 0.35 };
/** Noise of a record over its mean: what is stated, and found. */
const NOISE = 0.01;

/** A table as a rig writes it. */
const table = (header, rows) => [header, ...rows.map((row) => row.join(','))].join('\n');

/** A file as it comes from a dialog. */
const file = (name, text) => ({ name, mimeType: 'text/csv', buffer: Buffer.from(text) });

/** Gives the page a file by the button. */
const choose = (lab, name, text) => lab.find('#record-file').setInputFiles(file(name, text));

/** Drops a file on the page. */
const drop = (lab, name, text) => lab.page.evaluate(([fileName, contents]) => {
  const data = new DataTransfer();
  data.items.add(new File([contents], fileName));
  document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
}, [name, text]);

/** The points of the record as they are drawn. */
const drawn = (lab) => lab.page.evaluate(async () => (await import('./curves.js')).measuredPoints());

/** A difference in the digits of a double, of numbers that went through units, or through as many digits as a table has. */
const near = (value, expected, tolerance = 1e-9) => assert.ok(Math.abs(value - expected) <= tolerance * Math.max(1, Math.abs(expected)), `${value} is not ${expected}`);

/** Times of 0 to 100 t* in ms, and a force of half of the mean static friction that swings by a tenth. */
function swing({ units }) {
  const rows = Array.from({ length: 101 }, (_, k) => [1e3 * k * units.time_s, units.friction_n * (0.5 + 0.05 * Math.sin(k / 5))]);
  return table('time (ms),force (N)', rows);
}

test('a record that is dropped is drawn over the curve, with its name in the legend, in the units of the case', async (t) => {
  const lab = await open(t, { toml: SMALL });
  assert.equal(await lab.find('#measured-row').isVisible(), false);
  const plot = () => lab.find('#plot-mu').screenshot();
  const { curve } = await lab.after(() => drop(lab, 'rig 12.csv', swing(lab.last.case)), 'record');
  assert.deepEqual([curve.along, curve.of, curve.values, curve.columns], ['time', 'force', 101, [0, 1]]);
  await lab.notice(say('record_drawn', { name: 'rig 12.csv', values: 101 }));
  await until(() => lab.find('#curve-measured').isVisible(), 'the legend');
  const { t: times, mu } = await drawn(lab);
  assert.equal(times.length, 101);
  times.forEach((time, k) => {
    near(time, k);
    near(mu[k], 0.5 + 0.05 * Math.sin(k / 5));
  });
  assert.ok(colours(await plot()) > 4);
  // Half of the coefficient makes the same force twice the friction of the case.
  await lab.find('#control-load').fill('50000');
  await lab.after(() => lab.find('#control-load').press('Enter'), 'case', ({ values }) => Math.abs(values.load.si - 5e4) < 1);
  await until(async () => Math.abs((await drawn(lab)).mu[0] - 1) < 1e-9, 'the record over half of the load');
  // It stays beside another case, until it is removed.
  await lab.after(() => lab.page.evaluate((hash) => (location.hash = hash), `#case=${link(PLAIN)}`), 'case', ({ why }) => why === 'open');
  await until(async () => Math.abs((await drawn(lab)).mu[0] - 0.5) < 1e-9, 'the record beside another case');
  assert.ok(await lab.find('#curve-measured').isVisible());
  await lab.press('open-measure');
  await lab.press('remove-record');
  await until(async () => !(await lab.find('#curve-measured').isVisible()), 'no legend');
  assert.equal(await lab.find('#measured-row').isVisible(), false);
  assert.deepEqual((await drawn(lab)).t, []);
});

test('a path becomes a time by the speed of the drive, and a coefficient is over that of the case', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const { units, values } = lab.last.case;
  const rows = Array.from({ length: 81 }, (_, k) => [1e6 * k * units.displacement_m * values.speed.star, 0.25 * units.friction_coefficient]);
  await lab.after(() => choose(lab, 'path.tsv', table('displacement (um),mu (1)', rows).replaceAll(',', '\t')), 'record');
  await until(async () => (await drawn(lab)).t.length === 81, 'the record');
  const { t: times, mu } = await drawn(lab);
  times.forEach((time, k) => near(time, k));
  mu.forEach((value) => near(value, 0.25));
});

test('a file that is no table says so, and asks for no columns', async (t) => {
  const lab = await open(t, { toml: SMALL });
  for (const [name, text] of [['notes.txt', 'words'], ['rig.lvm', 'words'], ['sheet.xlsx', 'PK\x03\x04 no workbook'], ['empty.csv', '']]) {
    const { problem, curve } = await lab.after(() => drop(lab, name, text), 'record', (record) => record.name === name);
    assert.equal(curve, null);
    await lab.reads('measure-problem', problem);
    assert.ok(await lab.find('#measure').isVisible() && !(await lab.find('#measure-columns').isVisible()), name);
  }
  // By its name a picture is no record.
  await choose(lab, 'picture.png', '');
  await lab.reads('measure-problem', say('record_unreadable', { name: 'picture.png' }));
  await lab.page.keyboard.press('Escape');
  assert.equal(await lab.find('#measured-row').isVisible(), false);
});

test('a table without units is asked for them, and for its columns', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const { units } = lab.last.case;
  const rows = Array.from({ length: 60 }, (_, k) => [k, 2e3 * k * units.time_s, 1e3 * units.friction_n]);
  const { problem, columns } = await lab.after(() => choose(lab, 'rig.csv', table('number,when,pull', rows)), 'record', ({ curve }) => curve === null);
  assert.deepEqual(columns.map(({ name }) => name), ['number', 'when', 'pull']);
  await until(() => lab.find('#measure').isVisible(), 'the dialog');
  await lab.reads('measure-problem', problem);
  assert.equal(await lab.find('#record-x option').count(), 3);
  // A unit that is none says so, and the dialog stays.
  await lab.find('#record-x').selectOption('2');
  await lab.find('#record-y').selectOption('3');
  await lab.find('#record-x-unit').fill('kilo');
  await lab.find('#record-y-unit').fill('mN');
  await lab.after(() => lab.press('read-again'), 'record', ({ curve }) => curve === null);
  await lab.reads('measure-problem', lab.last.record.problem);
  assert.deepEqual([await lab.find('#record-x').inputValue(), await lab.find('#record-y').inputValue()], ['2', '3']);
  await lab.find('#record-x-unit').fill('ms');
  const { curve } = await lab.after(() => lab.press('read-again'), 'record', (record) => record.curve !== null);
  assert.deepEqual(curve.columns, [1, 2]);
  await until(async () => !(await lab.find('#measure').isVisible()), 'no dialog');
  const { t: times, mu } = await drawn(lab);
  near(times[10], 20);
  near(mu[10], 1);
});

test('a record is shifted by hand, and to where it is closest to the curve', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.runToEnd();
  const { units } = lab.last.case;
  const points = await lab.page.evaluate(async () => (await import('./curves.js')).curvePoints());
  // The run itself, 30 t* later.
  const rows = points.t.map((time, k) => [1e3 * (time + 30) * units.time_s, points.mu[k] * units.friction_n]);
  await lab.after(() => choose(lab, 'late.csv', table('time (ms),force (N)', rows)), 'record');
  await until(async () => (await drawn(lab)).t.length > 100, 'the record');
  near((await drawn(lab)).t[0], points.t[0] + 30, 1e-6);
  await lab.press('fit-shift');
  // The record and the curve are the same numbers.
  await until(async () => Math.abs((await drawn(lab)).t[0] - points.t[0]) < 1e-5, async () => `a fitted shift; the record begins at ${(await drawn(lab)).t[0]}`);
  const shown = Number(await lab.find('#shift').inputValue());
  const [factor] = { s: [1], ms: [1e-3], '\u00b5s': [1e-6], ns: [1e-9] }[await lab.text('shift-unit')];
  near(shown * factor, -30 * units.time_s, 1e-4 * 30 * units.time_s);
  await lab.find('#shift').fill('0');
  await until(async () => Math.abs((await drawn(lab)).t[0] - points.t[0] - 30) < 1e-6, 'no shift');
  // Of a run that has just begun there is less than half of the record.
  await lab.find('#pace').press('Home');
  await lab.after(() => lab.press('rest'), 'curve', ({ from_rest: isFromRest }) => isFromRest);
  await lab.press('fit-shift');
  await lab.notice(say('shift_not_fitted'));
});

test('a force is not compared with a slider that is turned', async (t) => {
  const lab = await open(t, { toml: readFileSync(path.join(ROOT, 'cases/torsion.toml'), 'utf8') });
  assert.equal(lab.last.case.units.friction_n, null);
  const rows = Array.from({ length: 60 }, (_, k) => [k, 0.3]);
  await lab.after(() => choose(lab, 'force.csv', table('time (ms),force (N)', rows)), 'record');
  await lab.reads('measured-note', say('not_comparable_force'));
  assert.equal(await lab.find('#curve-measured').isVisible(), false);
  await lab.after(() => choose(lab, 'coefficient.csv', table('time (ms),mu (1)', rows)), 'record');
  await lab.reads('measured-note', '');
  await until(() => lab.find('#curve-measured').isVisible(), 'the coefficient');
});

/** A record of the tiny slider with the truth, on another surface, with noise. */
async function recordOfTruth() {
  const name = 'truth.toml';
  writeFileSync(path.join(WORK, name), TINY);
  const sets = Object.entries({ ...TRUTH, 'friction.seed': 5 }).flatMap(([key, value]) => ['--set', `${key}=${value}`]);
  await slipfront('run', name, '--quiet', '--force', '--out', 'truth', ...sets);
  const [header, ...lines] = readFileSync(path.join(WORK, 'truth/series.csv'), 'utf8').trim().split('\n').map((line) => line.split(','));
  const rows = lines.map((line) => ['time_s', 'friction_force_n'].map((column) => Number(line[header.indexOf(column)])));
  const mean = rows.reduce((sum, [, force]) => sum + force, 0) / rows.length;
  // Sums of twelve numbers of a generator of 32 bits are nearly normal, with a variance of 1.
  let random = 1;
  const uniform = () => (random = (Math.imul(random, 1664525) + 1013904223) >>> 0) / 2 ** 32;
  const normal = () => Array.from({ length: 12 }, uniform).reduce((sum, value) => sum + value, -6);
  const noisy = rows.filter((_, k) => k > 0 && k % 4 === 0).map(([time, force]) => [1e9 * time, force + NOISE * mean * normal()]);
  return table('time (ns),force (N)', noisy);
}

/** Loads the record of the truth and opens the dialog of the calibration. */
async function withRecord(t, options = {}) {
  const lab = await open(t, { toml: TINY, ...options });
  await lab.after(async () => choose(lab, "rig's.csv", await recordOfTruth()), 'record', ({ curve }) => curve !== null);
  await lab.press('open-calibrate');
  return lab;
}

test('two unknowns of a record are found, with their intervals; using them is one step of undo', async (t) => {
  const lab = await withRecord(t);
  // The noise is found by the scatter of the values.
  const noise = Number(await lab.find('#calibrate-noise').inputValue());
  assert.ok(noise >= 100 * NOISE * 0.8 && noise <= 100 * NOISE * 1.5, `${noise} % of noise`);
  for (const key of ['calibrate_how', 'calibrate_more']) assert.ok((await lab.text('calibrate')).includes(say(key)));
  // One unknown is too few, and five are too many.
  await lab.find('#unknown-r_star').uncheck();
  await lab.reads('calibrate-count', say('calibrate_count_wrong', { count: 1 }));
  assert.ok(await lab.find('#calibrate-start').isDisabled());
  for (const id of ['r_star', 'damping_rate', 'pressure', 'sigma']) await lab.find(`#unknown-${id}`).check();
  assert.ok(await lab.find('#calibrate-start').isDisabled());
  for (const id of ['damping_rate', 'pressure', 'sigma']) await lab.find(`#unknown-${id}`).uncheck();
  await lab.reads('calibrate-count', say('calibrate_count', { count: 2 }));
  await lab.find('#unknown-mu_static-from').fill('much');
  await lab.press('calibrate-start');
  await lab.reads('calibrate-problem', say('range_wrong', { name: say('unknown_mu_static') }));
  await lab.find('#unknown-mu_static-from').fill('0.3');
  for (const [from, to] of [['x', ''], ['', 'x'], ['2', '1'], ['1', '1']]) {
    await lab.find('#calibrate-from').fill(from);
    await lab.find('#calibrate-to').fill(to);
    await lab.press('calibrate-start');
    await lab.reads('calibrate-problem', say('part_wrong'));
  }
  await lab.find('#calibrate-from').fill('');
  // The last part of the record does not count.
  const { x } = lab.last.record.curve;
  const unit = await lab.text('calibrate-part-unit');
  const last = x[x.length - 1] * 0.9;
  const of = { ns: 1e-9, '\u00b5s': 1e-6, ms: 1e-3, s: 1 }[unit];
  await lab.find('#calibrate-to').fill(String(Number((last / of).toPrecision(6))));
  const stages = new Set();
  const hear = lab.hear.bind(lab);
  lab.hear = (payload) => {
    hear(payload);
    if (lab.last.calibrating) stages.add(lab.last.calibrating.stage);
  };
  await lab.after(() => lab.press('calibrate-start'), 'calibrating');
  // The page is there meanwhile.
  await until(async () => !(await lab.find('#calibrate').isVisible()), 'no dialog');
  await until(async () => /\d+ of \d+ runs$/.test(await lab.text('calibrating-state')), 'how far it is');
  const { results, outcome } = await until(() => lab.last.calibrated, 'the end of the calibration');
  assert.equal(outcome, 'done');
  // A stage that is shorter than the time between two reports is in none of them: here that may be any but the first.
  const [first, ...later] = stages;
  assert.ok(first === 'training' && later.length > 0, [...stages].join(' '));
  assert.equal(results.is_refused, false, results.report);
  assert.deepEqual(results.unknowns.map(({ key }) => key).sort(), Object.keys(TRUTH).sort());
  for (const { key, interval: [low, high], median } of results.unknowns) {
    // Each interval holds the truth in nine of ten records; three times its half width holds it in all of them
    // that a test may meet.
    assert.ok(Math.abs(median - TRUTH[key]) <= 1.5 * (high - low), `${key}: ${low} to ${high}, and it was ${TRUTH[key]}`);
  }
  await until(async () => !(await lab.find('#calibrating-row').isVisible()), 'no progress');
  await lab.press('show-calibrated');
  await lab.reads('verdict', say('verdict_accepted'));
  assert.equal(await lab.find('#found-numbers tr').count(), 2);
  const rows = await lab.find('#found-numbers tr').allTextContents();
  results.unknowns.forEach(({ key, median, is_determined: is }, k) => {
    assert.ok(rows[k].includes(key) && rows[k].includes(String(Number(median.toPrecision(3)))), rows[k]);
    assert.ok(rows[k].endsWith(say(is ? 'determined' : 'not_determined')), rows[k]);
  });
  assert.equal(await lab.text('calibration-report'), results.report);
  assert.equal(await lab.text('calibration-command'), "slipfront calibrate calibration.toml 'rig'\\''s.csv'");
  const { name, contents } = await lab.download(() => lab.press('download-calibration'));
  assert.deepEqual([name, contents.toString()], ['calibration.toml', results.toml]);
  // The command finds the same.
  writeFileSync(path.join(WORK, 'calibration.toml'), contents);
  writeFileSync(path.join(WORK, 'rig.csv'), await recordOfTruth());
  const printed = await slipfront('calibrate', 'calibration.toml', 'rig.csv', '--force');
  for (const { key, median } of results.unknowns) assert.match(printed, new RegExp(`${key}\\s+${Number(median.toPrecision(4))}`));
  near(Number(/^to = "([^ ]+) s"$/m.exec(results.toml)[1]), last, 1e-5);
  const { toml } = lab.last.case;
  const used = await lab.after(() => lab.press('use-numbers'), 'case', ({ why }) => why === 'change');
  near(used.values.r_star.star, results.set['friction.r_star']);
  near(used.units.friction_coefficient, results.set['friction.mu_static']);
  assert.equal((await lab.after(() => lab.press('undo'), 'case')).toml, toml);
  // The results are still there, and a search begins with them.
  await lab.press('show-calibrated');
  await lab.after(() => lab.press('use-and-find'), 'finding');
  near(lab.last.case.values.r_star.star, results.set['friction.r_star']);
  await lab.reads('find', say('find_stop'));
});

test('a calibration is stopped, given up when the case is changed, and says why it has failed', async (t) => {
  const lab = await withRecord(t);
  // Long enough to be stopped.
  await lab.find('#calibrate-runs').fill('5000');
  await lab.after(() => lab.press('calibrate-start'), 'calibrating');
  await until(() => lab.find('#calibrating-row').isVisible(), 'the progress');
  const { outcome } = await lab.after(() => lab.press('calibrating-stop'), 'calibrated');
  assert.equal(outcome, 'stopped');
  await lab.notice(say('calibration_stopped'));
  await until(async () => !(await lab.find('#calibrating-row').isVisible()), 'no progress');
  assert.equal(await lab.find('#calibrated-row').isVisible(), false);
  await lab.press('open-calibrate');
  await lab.after(() => lab.press('calibrate-start'), 'calibrating');
  await lab.find('#control-r_star').fill('0.4');
  await lab.after(() => lab.find('#control-r_star').press('Enter'), 'calibrated', (end) => end.outcome === 'given_up');
  await lab.notice(say('calibration_given_up'));
  await lab.press('open-calibrate');
  await lab.find('#unknown-mu_static-from').fill('-1');
  const { sentence } = await lab.after(() => lab.press('calibrate-start'), 'calibrated', (end) => end.outcome === 'failed');
  await until(async () => await lab.find('#calibrate').isVisible() ? await lab.text('calibrate-problem') === sentence.split('\n')[0] : (await lab.text('notices')).includes(sentence), 'why it has failed');
});

test('a record that the model cannot have made is said to be that first', async (t) => {
  const lab = await open(t, { toml: TINY });
  const { units } = lab.last.case;
  // Friction that rises and falls as no slider on springs does.
  const rows = Array.from({ length: 300 }, (_, k) => [1e9 * 0.5 * (k + 1) * units.time_s, units.friction_n * (1 + 0.5 * Math.sin(k / 9))]);
  await lab.after(() => choose(lab, 'odd.csv', table('time (ns),force (N)', rows)), 'record', ({ curve }) => curve !== null);
  await lab.press('open-calibrate');
  await lab.after(() => lab.press('calibrate-start'), 'calibrating');
  const { results } = await until(() => lab.last.calibrated, 'the end of the calibration');
  assert.equal(results.is_refused, true, results.report);
  await lab.press('show-calibrated');
  await lab.reads('verdict', say('verdict_refused'));
  assert.ok(await lab.find('#calibration-report').isVisible());
});
