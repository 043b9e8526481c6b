// The modules of the page that need no browser: `node --test crates/slipfront-lab/tests/page/`.
import assert from 'node:assert/strict';
import { randomBytes } from 'node:crypto';
import fs from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { fromBase64, toBase64 } from '../../web/base64.js';
import { Camera } from '../../web/camera.js';
import { COLOURMAPS } from '../../web/colourmaps.js';
import { fittedShift } from '../../web/fit_shift.js';
import { parse } from '../../web/frames.js';
import { rowsOf } from '../../web/letters.js';
import { makeLink, readLink } from '../../web/link.js';
import { fixed, length, metres, number, quantity, ticks, typed } from '../../web/quantity.js';
import { alongUnit, inStars, roundedUp, unitOf } from '../../web/record.js';
import { center, coverageOf, create, enlarge, handles, inside, kind, move, turn } from '../../web/shapes.js';
import { endText, rangeOf, unknownsOf } from '../../web/unknowns.js';

const WEB = fileURLToPath(new URL('../../web', import.meta.url));
const SLIDER = { blocks: [50, 40], blockSize: 1e-6, count: 2000 };
// Numbers of one rounding: a few units of the last digit of a double.
const near = (value, expected) => assert.ok(Math.abs(value - expected) <= 1e-12 * Math.max(1, Math.abs(expected)), `${value} is not ${expected}`);
const sources = fs.readdirSync(WEB).filter((name) => name.endsWith('.js'));
const read = (name) => fs.readFileSync(path.join(WEB, name), 'utf8');

test('every word that is asked for stands in en.json, and every word there is asked for', () => {
  const words = Object.keys(JSON.parse(read('en.json')));
  const all = ['index.html', ...sources].map(read).join('\n');
  const asked = [...all.matchAll(/(?:data-(?:say|label|hint|blank)="|say\('|key: ')([a-z_]+)["']/g)].map((match) => match[1]);
  // `key: '...'` is also the name of a field of a shape, which is asked for with its prefix.
  const missing = asked.filter((key) => !words.includes(key) && !words.includes(`shape_${key}`) && key !== 'time');
  assert.deepEqual(missing, []);
  const parts = [...all.matchAll(/say\(`([a-z_]+_)\$\{/g)].map((match) => match[1]);
  const unused = words.filter((word) => !new RegExp(`['"\`]${word}['"\`]`).test(all) && !parts.some((part) => word.startsWith(part)));
  assert.deepEqual(unused, []);
});

test('modules import no circle', () => {
  const imports = Object.fromEntries(sources.map((name) => [name, [...read(name).matchAll(/from '\.\/([a-z_]+\.js)'/g)].map((match) => match[1])]));
  const visit = (name, above) => {
    assert.ok(!above.includes(name), [...above, name].join(' -> '));
    for (const next of imports[name]) visit(next, [...above, name]);
  };
  for (const name of sources) visit(name, []);
});

test('modules hold no style attribute and no character beyond ASCII', () => {
  for (const name of ['index.html', ...sources]) {
    assert.doesNotMatch(read(name), /[^\x00-\x7f]/, name);
    assert.doesNotMatch(read(name), /style="|setAttribute\('style'/, name);
  }
});

test('types are checked in every module, and none of them is left open', () => {
  for (const name of sources) {
    assert.ok(read(name).startsWith('// @ts-check\n'), name);
    assert.doesNotMatch(read(name), /[{<(,|] ?any\b|: any[,;)}=\]]/, name);
  }
});

test('types/page.d.ts has the elements of index.html that are more than an HTMLElement', () => {
  const kinds = { button: 'Button', canvas: 'Canvas', details: 'Details', dialog: 'Dialog', form: 'Form', input: 'Input', progress: 'Progress', select: 'Select' };
  const found = [...read('index.html').matchAll(/<([a-z]+)\s[^>]*?\bid="([^"]+)"/g)].filter(([, tag]) => tag in kinds);
  const declared = read('../types/page.d.ts').split('interface Elements {')[1];
  const types = [...declared.matchAll(/^ {2}'?([a-z-]+)'?: HTML(\w+)Element;$/gm)];
  assert.deepEqual(types.map(([, id, kind]) => [id, kind]), found.map(([, tag, id]) => [id, kinds[tag]]));
});

test('quantities have the prefix that leaves one to three digits before the point', () => {
  assert.equal(quantity(0.0379, 'm/s'), '37.9 mm/s');
  assert.equal(quantity(1e5, 'Pa'), '100 kPa');
  assert.equal(quantity(0, 'm'), '0 m');
  assert.equal(quantity(3.1e8, '1/s'), '3.1e8 1/s');
  assert.equal(number(-0.25), '\u22120.25');
  assert.equal(fixed(null), '\u2013');
  assert.equal(fixed(-31.04, 1), '\u221231.0');
});

test('lengths are read with every prefix of the case file, and nothing else is', () => {
  near(metres('25 um'), 25e-6);
  near(metres('1e-3m'), 1e-3);
  near(metres('-15 \u00b5m'), -15e-6);
  assert.equal(metres('middle'), null);
  assert.equal(metres('25'), null);
  assert.equal(length(25e-6), '25 um');
});

test('typed numbers may have a comma, and words are none', () => {
  assert.equal(typed(' 7,5 '), 7.5);
  assert.equal(typed('\u22123'), -3);
  assert.equal(typed(''), null);
  assert.equal(typed('a'), null);
});

test('ticks are round and within the bar', () => {
  assert.deepEqual(ticks(0, 1), [0, 0.5, 1]);
  assert.deepEqual(ticks(0, 145), [0, 50, 100]);
  assert.deepEqual(ticks(3, 3), [3]);
});

test('both colour maps have 256 colours, from dark to bright', () => {
  for (const digits of Object.values(COLOURMAPS)) assert.match(digits, /^[0-9a-f]{1536}$/);
  assert.equal(COLOURMAPS.viridis.slice(0, 6), '440154');
});

test('a picture is read as it is laid out', () => {
  const view = new DataView(new ArrayBuffer(36 + 6));
  [[0, 1], [1, 5]].forEach(([at, value]) => view.setUint8(at, value));
  view.setUint16(2, 1, true);
  [[4, 7], [8, 70]].forEach(([at, value]) => view.setUint32(at, value, true));
  [0.5, 0.25, 75, -1, 2].forEach((value, k) => view.setFloat32(12 + 4 * k, value, true));
  view.setUint16(32, 3, true);
  view.setUint16(34, 2, true);
  view.setUint8(41, 253);
  const [topic, picture] = parse(view.buffer);
  assert.equal(topic, 'picture');
  assert.deepEqual({ ...picture, bytes: [...picture.bytes] }, {
    field: 'first_slip', unit: 't*', recorded: true, number: 7, step: 70, tStar: 0.5, muStar: 0.25, slidingPercent: 75, low: -1, high: 2, nx: 3, ny: 2, bytes: [0, 0, 0, 0, 0, 253],
  });
});

test('a kymograph is read as it is laid out', () => {
  const view = new DataView(new ArrayBuffer(28 + 2));
  view.setUint8(0, 2);
  [[4, 1], [8, 2]].forEach(([at, value]) => view.setUint32(at, value, true));
  [0.5, 1, 0, 25].forEach((value, k) => view.setFloat32(12 + 4 * k, value, true));
  const [topic, { rows, bins, firstStar, lastStar, edgeBlocks, binBlocks, bytes }] = parse(view.buffer);
  assert.deepEqual([topic, rows, bins, firstStar, lastStar, edgeBlocks, binBlocks, bytes.length], ['kymograph', 1, 2, 0.5, 1, 0, 25, 2]);
});

test('a link gives the case back, and one that is too long is not made', async () => {
  const content = { name: 'circle', toml: 'name = "\u03bc"\n', files: { 'texture.png': toBase64(new Uint8Array([0, 255, 62])) } };
  assert.deepEqual(await readLink(await makeLink(content)), content);
  assert.deepEqual([...fromBase64(content.files['texture.png'])], [0, 255, 62]);
  // Random bytes cannot be packed: 20 000 of them are 26 667 characters.
  const noise = toBase64(randomBytes(20_000));
  assert.ok((await makeLink({ toml: noise, files: {} })) === null);
  await assert.rejects(readLink('broken'));
  for (const odd of [{ toml: 1 }, { toml: '', name: 1 }, { toml: '', files: { a: 1 } }, { toml: ' '.repeat(8e6) }, null]) {
    const link = await makeLink(odd);
    await assert.rejects(readLink(link), JSON.stringify(odd)?.slice(0, 40));
  }
});

test('a pixel goes to blocks and back, and zooming keeps what is below the pointer', () => {
  const camera = new Camera();
  camera.pixels = [600, 500];
  camera.reset([50, 40]);
  assert.deepEqual(camera.toPixels([25, 20]), [300, 250]);
  const before = camera.toBlocks([350, 210]);
  camera.enlarge(3, [350, 210]);
  camera.toBlocks([350, 210]).forEach((value, axis) => near(value, before[axis]));
  camera.toPixels(camera.toBlocks([10, 20])).forEach((value, axis) => near(value, [10, 20][axis]));
  camera.enlarge(1e-9);
  assert.deepEqual([camera.zoom, camera.x, camera.y], [1, 25, 20]);
});

test('the coverage of a cavity is Eq. 18', () => {
  near(coverageOf(10e-6, {}, SLIDER), (100 * Math.PI * 100) / 2000);
  // An ellipse of half-axes 16 and 4 blocks has the area pi 64.
  near(coverageOf(10e-6, { s: 1, w: 0.6 }, SLIDER), (100 * Math.PI * 64) / 2000);
});

test('new shapes stand where they were placed, as large as they were dragged', () => {
  const circle = create('circle', {}, [10, 20], 5, SLIDER);
  assert.deepEqual(circle.center, ['10 um', '20 um']);
  // Four digits are kept.
  assert.equal(circle.coverage, 3.927);
  assert.deepEqual(create('groove', { orientation: 'along' }, [10, 25], 2, SLIDER), { shape: 'groove', orientation: 'along', coverage: 10, offset: '5 um' });
  assert.deepEqual(create('array', { columns: 3, rows: 2 }, [25, 20], 0, SLIDER), { shape: 'cavity', center: ['25 um', '20 um'], array: [3, 2], coverage: 10 });
  assert.deepEqual(['circle', 'ellipse', 'polygon', 'array'].map((tool) => kind(create(tool, { s: 2, w: 0.5, columns: 2, rows: 2 }, [1, 1], 0, SLIDER))), ['circle', 'ellipse', 'polygon', 'array']);
});

test('shapes are moved, sized and turned', () => {
  const cavity = { shape: 'cavity', coverage: 8 };
  assert.deepEqual(move(cavity, [1, -2], SLIDER).center, ['26 um', '18 um']);
  assert.deepEqual(center(cavity, SLIDER).map(length), ['25 um', '20 um']);
  assert.equal(enlarge(cavity, 0.5).coverage, 2);
  assert.equal(enlarge({ shape: 'cavity', lambda: '4 um' }, 0.5).lambda, '2 um');
  assert.equal(enlarge({ shape: 'groove', coverage: 8 }, 0.5).coverage, 4);
  assert.equal(enlarge({ shape: 'cavity', coverage: 90 }, 2).coverage, 99);
  assert.equal(move({ shape: 'groove', orientation: 'across' }, [3, 9], SLIDER).offset, '3 um');
  const square = { shape: 'polygon', points: [['0 um', '0 um'], ['4 um', '0 um'], ['4 um', '4 um'], ['0 um', '4 um']] };
  assert.deepEqual(enlarge(square, 0.5).points[0], ['1 um', '1 um']);
  assert.deepEqual(move(square, [1, 1], SLIDER).points[0], ['1 um', '1 um']);
  assert.equal(turn({ shape: 'cavity', rotate: 178 }, 5).rotate, -177);
});

test('what is inside follows from the even-odd rule, and handles are on the box', () => {
  const ring = [[[0, 0], [4, 0], [4, 4], [0, 4]], [[1, 1], [3, 1], [3, 3], [1, 3]]];
  assert.deepEqual([[0.5, 0.5], [2, 2], [5, 2]].map((point) => inside(ring, point)), [true, false, false]);
  assert.deepEqual(handles({ shape: 'cavity' }, ring[0]), [[0, 0], [4, 0], [4, 4], [0, 4]]);
  assert.deepEqual(handles({ shape: 'groove', orientation: 'across' }, ring[0]), [[0, 2], [4, 2]]);
});

test('letters that would lie on each other stand in rows', () => {
  assert.deepEqual(rowsOf([0, 50, 100, 105, 108, 140], 10), [0, 0, 0, 1, 2, 0]);
  assert.deepEqual(rowsOf([], 10), []);
});

/** A curve that rises, peaks and swings, at so many times. */
function swinging(first, last, count) {
  const t = Array.from({ length: count }, (_, k) => first + ((last - first) * k) / (count - 1));
  return { t, mu: t.map((time) => (time < 30 ? time / 30 : 0.5 + 0.5 * Math.exp((30 - time) / 20) * Math.cos(time - 30))) };
}

test('the shift of a record that is a piece of the curve is found, whichever it is', () => {
  const curve = swinging(0, 100, 1001);
  for (const shift of [0, 7.25, -40.123456, 1000]) {
    const { t, mu } = curve;
    const piece = { t: t.slice(100, 900).map((time) => time - shift), mu: mu.slice(100, 900) };
    const found = fittedShift(piece, curve);
    // The golden section leaves 1e-12 of its interval; near its least value, a square, the distance is that of
    // its sums, so that the place is known to about 1e-9 of the spacing of the points and better.
    assert.ok(Math.abs(found - shift) < 1e-7, `${found} is not ${shift}`);
  }
});

test('a shift is fitted through noise, and by half of a record at least', () => {
  const curve = swinging(0, 100, 1001);
  // Noise of 2 % by a generator of 32 bits.
  let random = 1;
  const noise = () => ((random = (Math.imul(random, 1664525) + 1013904223) >>> 0) / 2 ** 32 - 0.5) * 0.04;
  const { t, mu } = swinging(0, 100, 3001);
  const found = fittedShift({ t: t.map((time) => time + 12), mu: mu.map((value) => value + noise()) }, curve);
  // Some 500 values of a scatter of 0.012 on slopes of about 0.3 in t*: 0.012/0.3/sqrt(500) is 0.002.
  assert.ok(Math.abs(found + 12) < 0.01, String(found));
  // The curve is shorter than half of the record, or none.
  assert.equal(fittedShift({ t, mu }, swinging(0, 45, 400)), null);
  assert.ok(Math.abs(fittedShift({ t, mu }, swinging(0, 60, 601))) < 1e-6);
  assert.equal(fittedShift({ t, mu }, { t: [], mu: [] }), null);
  assert.equal(fittedShift({ t: [1], mu: [1] }, curve), null);
});

test('records stand in t* and mu* of the case, with their shift', () => {
  const shown = { units: { time_s: 0.5, displacement_m: 1e-3, friction_n: 4, friction_coefficient: 0.25 }, values: { speed: { star: 0.1, si: 1 } } };
  const record = { along: 'time', of: 'force', x: [0, 1], y: [2, 4] };
  assert.deepEqual(inStars(record, 1, shown), { t: [2, 4], mu: [0.5, 1] });
  const path = { ...record, along: 'displacement', of: 'coefficient' };
  const { t, mu } = inStars(path, 0, shown);
  t.forEach((value, k) => near(value, [0, 1e4][k]));
  assert.deepEqual(mu, [8, 16]);
  near(alongUnit(path, shown), 1e-4);
  // A slider that is turned has a torque, and a drive that stands no time for a path.
  const turned = { ...shown, units: { ...shown.units, friction_n: null } };
  assert.equal(inStars(record, 0, turned), null);
  assert.ok(inStars({ ...record, of: 'coefficient' }, 0, turned) !== null);
  assert.equal(inStars(path, 0, { ...shown, values: {} }), null);
  // The unit is that of the end farther from 0.
  assert.deepEqual(unitOf(record), [1, 's']);
  assert.deepEqual(unitOf({ ...path, x: [-2e-3, 1e-4] }), [1e-3, 'mm']);
});

test('noise is rounded up to two digits, and is never none', () => {
  assert.deepEqual([0, 0.1, 0.1001, 1.234, 9.91, 12.01].map(roundedUp), [0.1, 0.1, 0.11, 1.3, 10, 13]);
});

test('ranges of unknowns lie around what the case has, and are written as a calibration file has them', () => {
  const shown = {
    loading_rate: 0.01,
    units: { time_s: 1e-6, friction_n: 2, friction_coefficient: 0.4 },
    values: { speed: { star: 0.03, si: 0.02 }, load: { star: 1e-6, si: 1.5e5 }, r_star: { star: 0.5, si: null }, omega_star: { star: 0.1, si: 2e5 }, sigma: { star: 0, si: null } },
  };
  const offered = unknownsOf(shown);
  const ends = Object.fromEntries(offered.map(({ id, from, to }) => [id, [from, to]]));
  // The spring takes 0.01 of 2 N in a microsecond at 0.02 m/s: 1e6 N/m.
  assert.deepEqual(ends, { mu_static: [0.24, 0.68], r_star: [0.2, 0.8], damping_rate: [5e4, 8e5], total_stiffness: [5e5, 2e6], pressure: [75, 300], sigma: [0.01, 0.15] });
  const of = (wanted) => offered.find(({ id }) => id === wanted);
  assert.deepEqual(rangeOf(of('mu_static'), 0.2, 0.6), [0.2, 0.6]);
  assert.deepEqual(rangeOf(of('pressure'), 75, 300), { from: '75 kPa', to: '300 kPa', scale: 'log' });
  assert.deepEqual(rangeOf(of('damping_rate'), 1, 10), { from: '1 1/s', to: '10 1/s', scale: 'log' });
  assert.equal(unknownsOf({ ...shown, loading_rate: null }).find(({ id }) => id === 'total_stiffness').from, null);
  assert.deepEqual([null, 0.24, 75, 6.8e7].map(endText), ['', '0.24', '75', '6.8e7']);
});
