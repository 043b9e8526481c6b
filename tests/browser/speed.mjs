// How fast the laboratory is here, as a table: steps and pictures in a second while the slider slides, the
// time from the brush to the picture, and the first picture of one file. Each is the median of five. Nothing
// else should work on the machine meanwhile, and the command should be a release build:
//
//     SLIPFRONT=target/release/slipfront CHANNEL=worker node tests/browser/speed.mjs
//
// With CHANNEL=worker the page has no server, and its simulation is WebAssembly: the table then also has its
// memory and sizes, and the bounds that hold on two quiet cores. Without, the page has the server. The
// command alone, on one thread, is timed for comparison.
import { readFileSync, statSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { browser, endAll, IS_ALONE, laboratory, sleep, until } from './page.mjs';
import { link, ROOT, slipfront, WORK } from './command.mjs';

const MEASUREMENTS = 5;
const SECONDS = 10;
/** t* from which the slider of 256 x 256 blocks slides as a whole. */
const SLIDING = 400;

/** The case `circle` with so many blocks along each side, which slides for as long as is looked at it. */
const circle = (blocks) => readFileSync(path.join(ROOT, 'cases/circle.toml'), 'utf8').replace('[50, 50]', `[${blocks}, ${blocks}]`) + '\n[time]\nduration_star = 1e5\n';

/** The middle one of some numbers. */
const median = (numbers) => numbers.toSorted((one, other) => one - other)[Math.floor(numbers.length / 2)];

/** The median of what `measure` gives, one after the other. */
async function measured(measure) {
  const found = [];
  for (let k = 0; k < MEASUREMENTS; k += 1) found.push(await measure());
  return median(found);
}

const rows = [];
/** Adds a row to the table: a quantity, its value, its bound. */
function tell(name, value, bound = '') {
  rows.push([name, value, bound]);
  console.error(`${name}: ${value}`);
}

/** Counts, in the page, frames with a new picture and steps that the session has told; keeps the connection. */
function watch() {
  const counts = (window.counts = { frames: 0, step: 0, t: 0, first: 0 });
  let drawn = 0;
  const { drawArrays } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.drawArrays = function (...values) {
    drawn += 1;
    return drawArrays.apply(this, values);
  };
  let told = 0;
  const eachFrame = () => {
    if (drawn > told && counts.step >= 0) counts.frames += 1;
    if (drawn > told && counts.pictures > 0 && counts.first === 0) counts.first = performance.now();
    told = drawn;
    requestAnimationFrame(eachFrame);
  };
  requestAnimationFrame(eachFrame);
  counts.pictures = 0;
  const listeners = new Set();
  const hear = (data) => {
    if (typeof data !== 'string') counts.pictures += 1;
    else if (data.includes('"is":"numbers"')) ({ step: counts.step, t_star: counts.t } = JSON.parse(data));
    for (const listen of listeners) listen(data);
  };
  window.connection = { listeners, send: () => {} };
  window.WebSocket = class extends WebSocket {
    constructor(...values) {
      super(...values);
      window.connection.send = (text) => this.send(text);
      this.addEventListener('message', ({ data }) => hear(data));
    }
  };
  window.Worker = class extends Worker {
    constructor(...values) {
      super(...values);
      window.connection.send = (text) => this.postMessage({ do: 'handle', text });
      this.addEventListener('message', ({ data: { is, data } }) => ['reply', 'picture', 'kymograph'].includes(is) && hear(data));
    }
  };
}

/** Milliseconds from a stroke of the brush to the frame with the picture after its case, as the page finds them for some strokes. */
async function lags() {
  const found = [];
  for (let stroke = 0; stroke < 21; stroke += 1) {
    const began = performance.now();
    await new Promise((resolve) => {
      let changed = false;
      const hear = (data) => {
        if (typeof data === 'string') changed ||= JSON.parse(data).why === 'change';
        else if (changed) {
          window.connection.listeners.delete(hear);
          requestAnimationFrame(resolve);
        }
      };
      window.connection.listeners.add(hear);
      const at = [20 + 10 * stroke, 20];
      window.connection.send(JSON.stringify({ do: 'paint', points: [at], radius: 4, textured: true, gesture: 1000 + stroke }));
    });
    found.push(performance.now() - began);
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  return found;
}

/** A page on a case, in a window of 1280 x 800, which goes as fast as it can. */
async function fast(blocks) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await page.addInitScript(watch);
  await page.goto(`${laboratory.address.replace(/&case=.*/, '')}&case=${link(circle(blocks))}`);
  const send = (request) => page.evaluate((text) => window.connection.send(text), JSON.stringify(request));
  const now = () => page.evaluate(() => ({ ...window.counts, seconds: performance.now() / 1000 }));
  await until(async () => (await now()).pictures > 0, 'a picture');
  await send({ do: 'view', twin: false, pace: 0, after_change: 'go_on' });
  return { page, send, now };
}

/** Numbers of a count in a second, over some seconds of a page. */
async function rates({ now }) {
  const before = await now();
  await sleep(1000 * SECONDS);
  const after = await now();
  const rate = (name) => (after[name] - before[name]) / (after.seconds - before.seconds);
  return { steps: rate('step'), frames: rate('frames') };
}

/** Steps in a second of the command on one thread while the slider slides. */
async function ofCommand() {
  const seconds = async (duration) => {
    writeFileSync(path.join(WORK, 'circle.toml'), circle(256).replace('1e5', String(duration)));
    const began = performance.now();
    await slipfront('run', 'circle.toml', '--threads', '1', '--no-pictures', '--quiet', '--force', '--set', 'output.snapshots=[]', '--out', 'timed');
    return (performance.now() - began) / 1000;
  };
  const manySteps = 4000;
  const [short, long] = [await seconds(SLIDING), await seconds(SLIDING + manySteps / 10)];
  return manySteps / (long - short);
}

/** Milliseconds until one file, opened from the disk in a browser that does not know it, shows its first picture. */
async function firstPicture(address) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
  const page = await context.newPage();
  await page.addInitScript(watch);
  await page.goto(address);
  const first = () => page.evaluate(() => window.counts.first);
  await until(first, 'a picture');
  const found = await first();
  await context.close();
  return found;
}

if (IS_ALONE) {
  for (const [name, bound] of [['slipfront.wasm', '<= 2.60'], ['slipfront-work.wasm', '']]) {
    tell(`${name}, MB`, (statSync(path.join(ROOT, 'target', name)).size / 1e6).toFixed(2), bound);
  }
  const file = path.join(WORK, 'one.html');
  await slipfront('lab', '--single', file);
  tell('first picture of one file, s', ((await measured(() => firstPicture(pathToFileURL(file).href))) / 1000).toFixed(2), '<= 1');
}
const command = await measured(ofCommand);
tell('steps/s of the command, one thread, sliding', command.toFixed(0));
const small = await fast(256);
await until(async () => (await small.now()).t > SLIDING, 'a slider that slides');
const both = [];
for (let k = 0; k < MEASUREMENTS; k += 1) both.push(await rates(small));
const steps = median(both.map((one) => one.steps));
tell('steps/s at 256 x 256, sliding, with pictures', steps.toFixed(0), IS_ALONE ? '>= 400' : '');
tell('pictures/s meanwhile, by frame callbacks', median(both.map((one) => one.frames)).toFixed(0), IS_ALONE ? '>= 30' : '');
tell('the command is faster, times', (command / steps).toFixed(2));
await small.send({ do: 'view', frames_per_second: 4, kymograph: false });
const alone = await measured(async () => (await rates(small)).steps);
tell('steps/s with four pictures a second', alone.toFixed(0));
tell('the command is faster than that, times', (command / alone).toFixed(2), IS_ALONE ? '<= 2.5' : '');
await small.send({ do: 'view', frames_per_second: 60, kymograph: true });
tell('brush to picture, ms, median of 21 strokes', median(await small.page.evaluate(lags)).toFixed(0), IS_ALONE ? '<= 100' : '');
await small.page.close();
if (IS_ALONE) {
  const large = await fast(512);
  await until(async () => (await large.now()).step > 100, 'a hundred steps');
  const bytes = await large.page.workers()[0].evaluate('module.memory.buffer.byteLength');
  tell('memory at 512 x 512, MB', (bytes / 1e6).toFixed(0), '<= 150');
  await large.page.close();
}
const width = Math.max(...rows.map(([name]) => name.length));
for (const [name, value, bound] of rows) console.log(`${name.padEnd(width)}  ${value.padStart(7)}  ${bound}`);
await endAll();
