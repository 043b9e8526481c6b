// @ts-check
// The session in a Worker of this page, as WebAssembly: there is no server and no disk. Work beside it, and
// runs that are saved, have Workers of their own.
import { isSingle, textOf } from './assets.js';
import { download } from './element.js';
import { loading, loadWork } from './module.js';
import { receive } from './receive.js';
import { put } from './store.js';
import { say } from './text.js';

/** A Worker that has failed is begun anew so often, and no more in this time: what fails again and again would for ever. */
const MOST_FAILURES = 3;
const FAILURES_MS = 60_000;

/** Workers beside the session that share the parts of one computation, at most: each has the memory of a run of its own. */
const MOST_WORKERS = 4;

/** @type {WebAssembly.Module|null} */
let module = null;
/** Where the script of Workers stands. */
let script = 'lab_worker.js';
/** What the session begins with: presets and the opening case. */
let beginning = '';
/** @type {Worker|null} */
let session = null;
/** Work beside the session, by its number. @type {Map<number, Worker>} */
const tasks = new Map();
/** Runs that are being saved, by their names. @type {Map<string, {worker: Worker, share: number}>} */
const saves = new Map();
/** When the session has failed. @type {number[]} */
let failures = [];

/** @import { Said } from '../types/worker' */

/** Begins a Worker with a module; it waits for one that is still to come. @param {WebAssembly.Module|Promise<WebAssembly.Module|null>} module @param {(said: Said, worker: Worker) => void} hear */
function begin(module, hear) {
  const worker = new Worker(script);
  worker.onmessage = ({ data }) => hear(data, worker);
  worker.onerror = (event) => {
    event.preventDefault();
    hear({ is: 'defect', number: 0, data: event.message ?? '' }, worker);
  };
  if (module instanceof WebAssembly.Module) worker.postMessage({ do: 'begin', module });
  else {
    module.then((loaded) => {
      if (loaded) worker.postMessage({ do: 'begin', module: loaded });
      else hear({ is: 'defect', number: 0, data: say('no_work') }, worker);
    });
  }
  return worker;
}

/** Begins work beside the session. @param {number} number @param {string} text */
function beginTask(number, text) {
  const worker = begin(loadWork(), ({ is, data }) => {
    if (is === 'event') session?.postMessage({ do: 'hear', number, text: data });
    else if (is === 'defect' || is === 'refusal') {
      console.error(data);
      session?.postMessage({ do: 'lost', number });
    }
    if (is !== 'event') endTask(number);
  });
  tasks.set(number, worker);
  worker.postMessage({ do: 'run', text });
}

/** @param {number} number */
function endTask(number) {
  tasks.get(number)?.terminate();
  tasks.delete(number);
}

function tellSaving() {
  const under_way = [...saves].map(([name, { share }]) => ({ name, share }));
  put('saving', { under_way });
}

/** Begins to save a run, which is offered as a file at its end. @param {string} text */
function beginSave(text) {
  const { name, document } = JSON.parse(text);
  if (saves.has(name)) return put('refused', { of: 'save', sentence: say('save_taken', { name }) });
  const worker = begin(loadWork(), (said) => {
    const { is, number, data } = said;
    if (is === 'share') {
      const save = saves.get(name);
      if (save) save.share = number / 1e6;
      return tellSaving();
    }
    endSave(name);
    if (is === 'archive') {
      download(new Blob([data], { type: 'application/zip' }), `${name}.zip`);
      put('saved', { name, folder: `${name}.zip`, folders: [] });
    } else put('refused', { of: 'save', sentence: say('save_failed', { name, sentence: is === 'refusal' ? data : say('worker_ended') }) });
  });
  saves.set(name, { worker, share: 0 });
  worker.postMessage({ do: 'save', text: JSON.stringify(document) });
  tellSaving();
}

/** @param {string} name */
function endSave(name) {
  saves.get(name)?.worker.terminate();
  saves.delete(name);
  tellSaving();
}

/** What the session says. @param {Said} said @param {Worker} worker */
function hear({ is, number, data }, worker) {
  if (worker !== session) return;
  if (is === 'reply' || is === 'picture' || is === 'kymograph') receive(data);
  else if (is === 'job') beginTask(number, data);
  else if (is === 'end') endTask(number);
  else if (is === 'save') beginSave(data);
  else if (is === 'stop_saving') endSave(data);
  else return fail(String(data));
  worker.postMessage({ do: 'read', messages: 1, pictures: is === 'picture' || is === 'kymograph' ? 1 : 0 });
}

/** The session has failed: it begins anew with the case that is shown, unless it fails again and again. @param {string} why */
function fail(why) {
  console.error(why);
  session?.terminate();
  session = null;
  for (const number of [...tasks.keys()]) endTask(number);
  const now = performance.now();
  failures = [...failures.filter((time) => now - time < FAILURES_MS), now];
  if (failures.length > MOST_FAILURES) return put('connected', { yes: false, ended: true });
  put('problem', { key: 'worker_failed' });
  open();
}

function open() {
  if (!module) return;
  session = begin(module, hear);
  // One core is left for the session.
  const workers = Math.max(1, Math.min(MOST_WORKERS, navigator.hardwareConcurrency - 1));
  session.postMessage({ do: 'open', text: beginning, workers });
}

/** Begins the session once it is loaded. */
export async function connect() {
  try {
    if (!loading) throw new Error(say('no_simd'));
    const [compiled, texts] = await loading;
    if (!compiled || !texts) throw new Error(say('no_module'));
    beginning = texts;
    module = compiled;
    if (isSingle) script = URL.createObjectURL(new Blob([(await textOf('lab_worker.js')) ?? ''], { type: 'text/javascript' }));
    open();
    put('connected', { yes: true });
  } catch (error) {
    put('failed', { sentence: error instanceof Error ? error.message : String(error) });
  }
}

/** Sends a message to the session. @param {string} message */
export const send = (message) => session?.postMessage({ do: 'handle', text: message });
