// How fast the laboratory is here: pictures drawn and steps taken in a second at two sizes, and the time from the brush to the picture.
// Nothing else should work on the machine meanwhile, and the command should be a release build:
//
//     SLIPFRONT=target/release/slipfront node tests/browser/speed.mjs
//
// With CHANNEL=worker the page has no server, and its simulation is WebAssembly.
import { browser, endAll, IS_ALONE, sleep } from './page.mjs';
import { link, serveExported, startLaboratory } from './command.mjs';

const SECONDS = 6;

/** Counts, in the page, what is drawn and what arrives; keeps the connection. */
function watch() {
  const counts = (window.counts = { drawn: 0, arrived: 0, step: 0 });
  const { drawArrays } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.drawArrays = function (...values) {
    counts.drawn += 1;
    return drawArrays.apply(this, values);
  };
  const listeners = new Set();
  const hear = (data) => {
    if (typeof data !== 'string') counts.arrived += 1;
    else if (JSON.parse(data).is === 'numbers') counts.step = JSON.parse(data).step;
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

/** Milliseconds from a stroke to the picture after its case, each of some strokes. */
async function lags() {
  const found = [];
  for (let stroke = 0; stroke < 20; stroke += 1) {
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
  return found.sort((one, other) => one - other);
}

for (const blocks of [256, 512]) {
  const toml = `slider.blocks = [${blocks}, ${blocks}]\ntime.duration_star = 1e5\n[[texture]]\nshape = "cavity"\ncoverage = 10\n`;
  const laboratory = await (IS_ALONE ? serveExported() : startLaboratory());
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await page.addInitScript(watch);
  await page.goto(`${laboratory.address}&case=${link(toml)}`);
  await sleep(2500);
  const send = (request) => page.evaluate((text) => window.connection.send(text), JSON.stringify(request));
  await send({ do: 'view', twin: false, pace: 0, after_change: 'go_on' });
  await sleep(1500);
  const now = () => page.evaluate(() => ({ ...window.counts, seconds: performance.now() / 1000 }));
  const before = await now();
  await sleep(1000 * SECONDS);
  const after = await now();
  const rate = (name) => ((after[name] - before[name]) / (after.seconds - before.seconds)).toFixed(1);
  const lag = await page.evaluate(lags);
  console.log(`${blocks} x ${blocks}: ${rate('drawn')} pictures drawn and ${rate('step')} steps a second; brush to picture ${lag[10].toFixed(0)} ms, at most ${lag[19].toFixed(0)} ms`);
  await page.close();
  await laboratory.stop();
}
await endAll();
