// @ts-check
// The folder of a run, dropped on the page or chosen: its files are read here, and the session replays it.
import { isAlone } from './assets.js';
import { toBase64 } from './base64.js';
import { find, onPress } from './element.js';
import { notice } from './notices.js';
import { open } from './session.js';
import { put } from './store.js';
import { say } from './text.js';

/** The server takes messages of 8 MiB, of which Base64 takes a quarter; a Worker has several copies of them in its memory. */
const MOST_BYTES = (isAlone ? 32 : 5.5) * 2 ** 20;
const FIELDS = 'fields.nc';
const NAMES = ['manifest.json', 'case.toml', 'summary.json', 'series.csv', FIELDS];
const INPUTS = 'inputs';

/** The files of a folder by their paths in it. @typedef {Map<string, File>} Files */

/** @param {Files} files */
const bytes = (files) => [...files.values()].reduce((sum, { size }) => sum + size, 0);

/** @param {File} file */
const inBase64 = async (file) => toBase64(new Uint8Array(await file.arrayBuffer()));

/** @param {string} name @param {Files} all */
async function replay(name, all) {
  const files = new Map([...all].filter(([path]) => NAMES.includes(path) || path.startsWith(`${INPUTS}/`)));
  const sizes = { name, most: MOST_BYTES / 2 ** 20 };
  if (bytes(files) > MOST_BYTES && files.delete(FIELDS)) notice(say('run_without_fields', sizes));
  if (bytes(files) > MOST_BYTES) return notice(say('run_too_large', sizes));
  const contents = await Promise.all([...files].map(async ([path, file]) => [path, await inBase64(file)]));
  put('lesson', null);
  open({ name, run: Object.fromEntries(contents) });
}

/** Replays a folder that is still to be read. @param {string} name @param {Promise<Files>} files */
export const replayWhenRead = (name, files) => files.then((all) => replay(name, all)).catch(() => notice(say('run_unreadable', { name })));

/** @param {FileSystemDirectoryEntry} folder @returns {Promise<FileSystemEntry[]>} */
async function entriesOf(folder) {
  const reader = folder.createReader();
  const all = [];
  for (;;) {
    // A browser gives some hundred of them at a time.
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return all;
    all.push(...some);
  }
}

/** The files of a folder and of its folder of inputs. @param {FileSystemDirectoryEntry} folder @returns {Promise<Files>} */
export async function filesOf(folder, prefix = '') {
  /** @type {Files} */
  const files = new Map();
  for (const entry of await entriesOf(folder)) {
    const path = `${prefix}${entry.name}`;
    if (entry.isFile) {
      const { file } = /** @type {FileSystemFileEntry} */ (entry);
      files.set(path, await new Promise((resolve, reject) => file.call(entry, resolve, reject)));
    } else if (path === INPUTS) {
      for (const [name, file] of await filesOf(/** @type {FileSystemDirectoryEntry} */ (entry), `${INPUTS}/`)) files.set(name, file);
    }
  }
  return files;
}

/** Prepares the button. */
export function startRunFolder() {
  const input = find('run-folder');
  find('open-run').hidden = !('webkitdirectory' in input);
  onPress('open-run', () => input.click());
  input.addEventListener('change', () => {
    const chosen = [...(input.files ?? [])].map((file) => ({ file, parts: file.webkitRelativePath.split('/') }));
    input.value = '';
    if (chosen.length === 0) return;
    find('presets').close();
    const files = new Map(chosen.map(({ file, parts }) => [parts.slice(1).join('/'), file]));
    replayWhenRead(chosen[0].parts[0], Promise.resolve(files));
  });
}
