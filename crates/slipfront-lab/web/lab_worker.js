// @ts-check
// A Worker of a page without a server: its session, work beside it, or a run that is saved, as WebAssembly.
//
// It asks nothing and knows nothing but the module and the texts that the page sends it.

/** @import { Asked, Begin, BytesSaying, Module, TextSaying } from '../types/worker' */

/** Names of the messages of the module, by their numbers: `MessageKind` in imports.rs of slipfront-wasm. */
const SAYINGS = ['reply', 'picture', 'kymograph', 'job', 'end', 'event', 'save', 'stop_saving', 'share', 'archive', 'bits', 'refusal', 'defect'];
/** Sayings that are bytes; all others are texts. */
const BYTES = ['picture', 'kymograph', 'archive'];
/** Pictures that the page may not have read yet before the newest alone is kept. */
const MOST_PICTURES = 2;
/** How long steps are taken before messages are looked for. */
const SLICE_MS = 10;

/** The module, of the session or of work beside it; until it has begun there is none. @type {Module} */
let module;
let unread = 0;
let unreadPictures = 0;
/** Pictures that wait for the page, by their kind. @type {Map<string, Uint8Array>} */
const waiting = new Map();
let timer = 0;
const { port1: soon, port2: later } = new MessageChannel();

/** @param {string} is @param {number} number @param {Uint8Array|string} data */
function post(is, number, data) {
  unread += 1;
  if (is === 'picture' || is === 'kymograph') unreadPictures += 1;
  if (typeof data === 'string') postMessage({ is, number, data });
  else postMessage({ is, number, data: data.buffer }, { transfer: [data.buffer] });
}

/** @param {number} what @param {number} number @param {number} at @param {number} length */
function say(what, number, at, length) {
  const is = SAYINGS[what];
  const bytes = new Uint8Array(module.memory.buffer, at, length).slice();
  if (!BYTES.includes(is)) return post(is, number, new TextDecoder().decode(bytes));
  if (is !== 'archive' && unreadPictures >= MOST_PICTURES) waiting.set(is, bytes);
  else post(is, number, bytes);
}

/** Gives the module a text. @param {string} text */
function giveText(text) {
  const bytes = new TextEncoder().encode(text);
  const at = module.room(bytes.length);
  new Uint8Array(module.memory.buffer, at, bytes.length).set(bytes);
}

/** Works for some milliseconds, and comes back when there is more to do. */
function advance() {
  clearTimeout(timer);
  const end = performance.now() + SLICE_MS;
  for (;;) {
    const now = performance.now();
    const due = module.advance(now, unread);
    if (due < 0) return;
    if (due > performance.now()) {
      timer = setTimeout(advance, due - performance.now());
      return;
    }
    if (now >= end) break;
  }
  soon.postMessage(null);
}
later.onmessage = () => advance();

/** Does what the page asks for. @param {Asked} asked */
function carryOut(asked) {
  if ('text' in asked) giveText(asked.text);
  if (asked.do === 'open') module.open(asked.workers);
  else if (asked.do === 'hear') module.hear(asked.number);
  else if (asked.do === 'lost') module.hear_lost(asked.number);
  else if (asked.do === 'read') {
    unread -= asked.messages;
    unreadPictures -= asked.pictures;
    for (const [is, bytes] of waiting) {
      if (unreadPictures >= MOST_PICTURES) break;
      waiting.delete(is);
      post(is, 0, bytes);
    }
  } else module[asked.do]();
  if (asked.do === 'run') post('done', 0, '');
}

/** Messages that came before the module was ready. @type {Asked[]} */
let early = [];

/** @param {Asked} asked */
function answer(asked) {
  try {
    carryOut(asked);
    if (asked.do !== 'run' && asked.do !== 'save') {
      clearTimeout(timer);
      timer = setTimeout(advance, 0);
    }
  } catch (error) {
    post('defect', 0, String(error));
  }
}

/** @param {MessageEvent<Begin|Asked>} event */
onmessage = async ({ data }) => {
  if (data.do === 'begin') {
    try {
      const instance = await WebAssembly.instantiate(data.module, { env: { say, now: () => performance.now(), date: () => giveText(new Date().toISOString()) } });
      module = /** @type {Module} */ (/** @type {unknown} */ (instance.exports));
      module.begin();
    } catch (error) {
      return post('defect', 0, String(error));
    }
    const all = early;
    early = [];
    all.forEach(answer);
  } else if (module) answer(data);
  else early.push(data);
};
