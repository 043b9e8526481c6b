// A page of the laboratory: what it and the server say to each other, and what a reader sees. When a test
// ends, its page is held to what holds of every page: no error, nothing that the content security policy had
// to stop, no request to another host.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import { chromium } from 'playwright-core';
import { PNG } from 'pngjs';
import { link, ROOT, serveExported, startLaboratory } from './command.mjs';

const WEB = path.join(ROOT, 'crates/slipfront-lab/web');

/** A word or a file of the page. */
export const webText = (file) => readFile(path.join(WEB, file), 'utf8');
export const webJson = async (file) => JSON.parse(await webText(file));
const words = await webJson('en.json');
/** A sentence of the page. */
export const say = (key, values = {}) => words[key].replace(/\{(\w+)\}/g, (_, name) => values[name]);

/** A small slider, smooth but for its cavity: less than a second from rest to the end. */
export const SMALL = `
[slider]
blocks = [20, 20]

[friction]
sigma_static_star = 0.02

[[texture]]
shape = "cavity"
coverage = 10

[time]
duration_star = 120
`;
export const PLAIN = SMALL.replace(/\[\[texture\]\][^[]*/, '');

/** Longer than any answer takes on a machine with other work, so that it ends only a test that fails. */
const PATIENCE_MS = 60_000;

/** Every message is given to the page up to so much later, which shows tests that do not wait for it. */
const DELAY_MS = Number(process.env.DELAY_MS ?? 0);

export const sleep = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

/** Waits until what `look` gives stays the same for a while, in which a run that goes on tells some ten times how far it is. */
export async function untilSame(look, what) {
  const sameForAWhile = async () => {
    const before = JSON.stringify(look());
    await sleep(2000 + DELAY_MS);
    return JSON.stringify(look()) === before;
  };
  await until(sameForAWhile, what);
}

/** Waits until `holds` gives something, and returns it. */
export async function until(holds, what) {
  const end = Date.now() + PATIENCE_MS;
  for (;;) {
    const found = await holds();
    if (found) return found;
    assert.ok(Date.now() < end, `${PATIENCE_MS / 1000} s passed, and not yet: ${typeof what === 'function' ? await what() : what}`);
    await sleep(20);
  }
}

export const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
    '--disable-gpu', '--enable-unsafe-swiftshader', '--force-color-profile=srgb', '--font-render-hinting=none'],
});
/** Whether the page has no server, and its session in a Worker. */
export const IS_ALONE = process.env.CHANNEL === 'worker';
/** For a test of what a page without a server has not. */
export const onServer = { skip: IS_ALONE && 'needs a server' };
/** For a test of a page without a server. */
export const withoutServer = { skip: !IS_ALONE && 'needs a page without a server' };
export const laboratory = await (IS_ALONE ? serveExported() : startLaboratory());

/** Ends the browser and the laboratory. */
export const endAll = () => Promise.all([browser.close(), laboratory.stop()]);

/** How many colours a picture has. */
export function colours(png) {
  const { data } = PNG.sync.read(png);
  return new Set(new Uint32Array(data.buffer, data.byteOffset, data.length / 4)).size;
}

/** What a message of bytes holds: a picture of the field, or a kymograph. */
function parse(bytes) {
  if (bytes[0] === 2) return ['kymograph', { rows: bytes.readUInt32LE(4), bins: bytes.readUInt32LE(8) }];
  const [recorded, step, t] = [bytes.readUInt16LE(2) & 1, bytes.readUInt32LE(8), bytes.readFloatLE(12)];
  return ['picture', { field: bytes[1], recorded: recorded === 1, step, t, values: bytes.subarray(36) }];
}

/** Lets a page tell with `handled()` each message of its session in a Worker that it has handled, and with `said()` what it has sent there. */
function tellHandledOfWorker(delay) {
  const told = ['reply', 'picture', 'kymograph'];
  const base64 = (buffer) => btoa(new Uint8Array(buffer).reduce((text, byte) => text + String.fromCharCode(byte), ''));
  window.workers = [];
  window.Worker = class extends Worker {
    constructor(...values) {
      super(...values);
      window.workers.push(this);
    }

    postMessage(message, ...rest) {
      if (message.do === 'handle') window.said(message.text);
      super.postMessage(message, ...rest);
    }

    set onmessage(handle) {
      const events = [];
      let due = 0;
      const next = () => {
        const event = events.shift();
        const { is, data } = event.data;
        // It is read before the page may give it on.
        const payload = typeof data === 'string' ? { text: data } : { base64: base64(data) };
        handle.call(this, event);
        if (told.includes(is)) window.handled(payload);
      };
      super.onmessage = (event) => {
        events.push(event);
        due = Math.max(due, performance.now() + delay * Math.random());
        if (delay > 0) setTimeout(next, due - performance.now());
        else next();
      };
    }
  };
}

/** Lets a page tell with `handled()` each message of its newest socket that it has handled. */
function tellHandled(delay) {
  let newest = null;
  window.WebSocket = class extends WebSocket {
    constructor(...values) {
      super(...values);
      newest = this;
    }

    set onmessage(handle) {
      const events = [];
      let due = 0;
      const next = () => {
        handle.call(this, events.shift());
        if (newest === this) window.handled();
      };
      super.onmessage = (event) => {
        events.push(event);
        due = Math.max(due, performance.now() + delay * Math.random());
        if (delay > 0) setTimeout(next, due - performance.now());
        else next();
      };
    }
  };
}

export class Lab {
  /** The newest message of each kind from the server that the page has handled, and how many there were. */
  last = {};
  count = {};
  /** What the page has sent. */
  sent = [];
  /** How often it has connected or tried to. */
  sockets = 0;
  /** Whether it is left without a server. */
  alone = false;
  /** Whether a test breaks its Worker. */
  breaks = false;
  faults = [];

  constructor(page, address) {
    this.page = page;
    this.address = address;
    page.on('pageerror', (error) => this.faults.push(`error: ${error.message}`));
    page.on('console', (message) => {
      if (['error', 'warning'].includes(message.type()) && !this.mayFail(message.text())) this.faults.push(`console: ${message.text()}`);
    });
    page.on('request', (request) => {
      const { hostname, protocol } = new URL(request.url());
      if (hostname !== '127.0.0.1' && !['blob:', 'data:', 'file:'].includes(protocol)) this.faults.push(`request: ${request.url()}`);
    });
    page.on('websocket', (socket) => {
      this.sockets += 1;
      const arrived = (this.arrived = []);
      socket.on('framesent', ({ payload }) => this.sent.push(JSON.parse(payload)));
      socket.on('framereceived', ({ payload }) => arrived.push(payload));
    });
  }

  /** Opens the page at its address. */
  async load(address) {
    if (IS_ALONE) {
      await this.page.exposeFunction('handled', ({ text, base64 }) => this.hear(text ?? Buffer.from(base64, 'base64')));
      await this.page.exposeFunction('said', (text) => this.sent.push(JSON.parse(text)));
      await this.page.addInitScript(tellHandledOfWorker, DELAY_MS);
    } else {
      await this.page.exposeFunction('handled', () => this.hear(this.arrived.shift()));
      await this.page.addInitScript(tellHandled, DELAY_MS);
    }
    await this.page.goto(address);
  }

  /** Software graphics are slow to read back, which Chromium tells as a warning; lost connections and blocked workers are told only where a test makes them so. */
  mayFail(text) {
    return /GPU stall due to ReadPixels|GL Driver Message|Service Worker registration blocked by Playwright/.test(text) || (this.alone && /WebSocket connection|net::ERR_CONNECTION_REFUSED/.test(text))
      || (this.breaks && /TypeError: module\[asked\.do\] is not a function/.test(text));
  }

  hear(payload) {
    const [kind, message] = typeof payload === 'string' ? [JSON.parse(payload).is, JSON.parse(payload)] : parse(payload);
    this.last[kind] = message;
    this.count[kind] = (this.count[kind] ?? 0) + 1;
  }

  /** Does something, and waits for the answer that follows it. */
  async after(action, kind, holds = () => true) {
    const before = this.count[kind] ?? 0;
    await action();
    return until(() => (this.count[kind] ?? 0) > before && holds(this.last[kind]) && this.last[kind], () => `an answer "${kind}" to ${action}; the last is ${JSON.stringify(this.last[kind])?.slice(0, 600)}; refused ${this.last.refused?.sentence}`);
  }

  find(selector) {
    return this.page.locator(selector);
  }

  press(id) {
    return this.find(`#${id}`).click();
  }

  text(id) {
    return this.find(`#${id}`).textContent();
  }

  /** Waits until the element has this text. */
  async reads(id, wanted) {
    const matches = (text) => (wanted instanceof RegExp ? wanted.test(text) : text === wanted);
    await until(async () => matches(await this.text(id)), async () => `#${id} reads "${await this.text(id)}" and not ${wanted}`);
  }

  /** Waits for a notice with this sentence. */
  notice(sentence) {
    return until(async () => (await this.text('notices')).includes(sentence), async () => `a notice "${sentence}" in "${await this.text('notices')}"`);
  }

  /** Lets the run go on as fast as it can, until it has ended and its last picture was sent; returns its numbers. */
  async runToEnd() {
    const pace = this.find('#pace');
    if (await pace.isVisible()) await pace.press('End');
    else await pace.evaluate((slider) => {
      // A telephone shows it at a press of a button: without it the key would scroll the page.
      Object.assign(slider, { value: slider.max }).dispatchEvent(new Event('input'));
    });
    if ((await this.text('pause')) === say('play')) await this.press('pause');
    const ended = () => this.last.numbers?.ended && this.last.picture?.step === this.last.numbers.step && this.last.numbers;
    return until(ended, () => `the end of the run; the last are ${JSON.stringify(this.last.numbers)}, step ${this.last.picture?.step}`);
  }

  /** Where a point in blocks is on the page, while the whole slider is seen. */
  async at([x, y]) {
    const { blocks } = this.last.case;
    const box = await this.find('#frame').boundingBox();
    const scale = Math.min(box.width / blocks[0], box.height / blocks[1]);
    return [box.x + box.width / 2 + (x - blocks[0] / 2) * scale, box.y + box.height / 2 - (y - blocks[1] / 2) * scale];
  }

  /** Presses the pointer at the first point, in blocks, and moves it over the others. */
  async drag(...points) {
    const [first, ...others] = await Promise.all(points.map((point) => this.at(point)));
    await this.page.mouse.move(...first);
    await this.page.mouse.down();
    for (const point of others) await this.page.mouse.move(...point, { steps: 4 });
    await this.page.mouse.up();
  }

  /** Presses what offers a file; returns its name and contents. */
  async download(action) {
    const [file] = await Promise.all([this.page.waitForEvent('download', { timeout: PATIENCE_MS }), action()]);
    return { name: file.suggestedFilename(), contents: await readFile(await file.path()) };
  }
}

/** Opens a page on a case. `calm` asks for little motion, so that the run stands still at first. `t` is the test that it belongs to. */
export async function open(t, { toml, files, address = laboratory.address, calm = true, keepNotices = false, ...options } = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, reducedMotion: calm ? 'reduce' : 'no-preference', ...options });
  context.setDefaultTimeout(PATIENCE_MS);
  const lab = new Lab(await context.newPage(), address);
  t.after(async () => {
    await context.close();
    assert.deepEqual(lab.faults, []);
  });
  await lab.load(toml === undefined ? address : `${address.replace(/&case=.*/, '')}&case=${link(toml, files)}`);
  await until(() => lab.last.case && lab.last.picture, 'the first picture');
  await until(async () => (await lab.text('case-name')) !== '', 'the name of the case');
  // What the page says at first lies above the field.
  if (!keepNotices) await lab.find('#notices button').evaluateAll((buttons) => buttons.forEach((button) => button.click()));
  return lab;
}
