// @ts-check
// Which case is open: that of the address, of the command line, or after a lost connection the one that was
// shown.
import { inAddress } from './address.js';
import { send } from './connection.js';
import { readLink } from './link.js';
import { notice, withdraw } from './notices.js';
import { next, on, put, state } from './store.js';
import { say } from './text.js';
import { sendView } from './view.js';

/** @import { CaseReply, Source } from '../types/protocol' */

/** Files are asked for when the case has stood still for so long: they are large, and only needed after a lost connection. */
const QUIET_MS = 1500;

let opened = false;
let quiet = 0;
/** @type {Record<string, string>} */
let files = {};

/** Opens another case; of one of the list it says what it is. @param {Source} source */
export function open(source) {
  withdraw('preset');
  const listed = state.hello?.presets.find(({ name }) => name === source.preset);
  if (listed) notice(say(listed.is_study ? 'preset_study' : 'preset_case', { title: listed.title }), { topic: 'preset' });
  put('recorded', null);
  put('selected', null);
  send({ do: 'open', source });
}

/** The present case with its files and as a zip. */
export function exported() {
  const answer = next('exported');
  send({ do: 'export' });
  return answer;
}

/** The case that the address names or holds; throws if there is none. @returns {Promise<Source>} */
async function ofAddress() {
  const [preset, named] = [inAddress('preset'), inAddress('case')];
  const listed = state.hello?.presets.find(({ name }) => name === (preset ?? named));
  if (listed) return { preset: listed.name };
  if (preset) throw new RangeError('no such case');
  return named ? readLink(named) : {};
}

async function first() {
  // The lesson of the address opens its own case.
  if (inAddress('lesson')) return;
  put('lesson', null);
  try {
    open(await ofAddress());
  } catch {
    put('problem', { key: 'broken_link' });
    open({});
  }
}

function begin() {
  sendView();
  if (!opened || !state.case) first();
  else send({ do: 'open', source: { name: state.case.name, toml: state.case.toml, files } });
  opened = true;
}

/** @param {CaseReply} shown */
function holdFiles(shown) {
  clearTimeout(quiet);
  if (shown.files.length === 0) files = {};
  else quiet = window.setTimeout(() => exported().then((content) => (files = content.files)), QUIET_MS);
}

/** Begins to listen. */
export function startSession() {
  on('hello', begin);
  on('case', holdFiles);
  window.addEventListener('hashchange', () => {
    const isView = inAddress('field') && !inAddress('case') && !inAddress('preset');
    if (!isView) first();
  });
}
