// @ts-check
// The folder of a run, dropped on the page or chosen, and files with a case or a run: they are read here, and
// the session replays the run.
import { isAlone } from './assets.js';
import { toBase64 } from './base64.js';
import { find, onPress } from './element.js';
import { notice } from './notices.js';
import { open } from './session.js';
import { put } from './store.js';
import { say } from './text.js';
import { filesOfZip } from './zip.js';

/** The server takes messages of 8 MiB, of which Base64 takes a quarter; a Worker has several copies of them in its memory. */
export const MOST_BYTES = (isAlone ? 32 : 5.5) * 2 ** 20;
const FIELDS = 'fields.nc';
const CASE = 'case.toml';
const SUMMARY = 'summary.json';
const NAMES = ['manifest.json', CASE, SUMMARY, 'series.csv', FIELDS];
const INPUTS = 'inputs';

/** The files of a folder by their paths in it. @typedef {Map<string, {size: number, arrayBuffer: () => Promise<ArrayBuffer>}>} Files */

/** @param {Files} files */
const bytes = (files) => [...files.values()].reduce((sum, { size }) => sum + size, 0);

/** The files in Base64. @param {Files} files @returns {Promise<Record<string, string>>} */
async function inBase64(files) {
  const contents = await Promise.all([...files].map(async ([path, file]) => [path, toBase64(new Uint8Array(await file.arrayBuffer()))]));
  return Object.fromEntries(contents);
}

/** @param {string} name @param {Files} all */
async function replay(name, all) {
  const files = new Map([...all].filter(([path]) => NAMES.includes(path) || path.startsWith(`${INPUTS}/`)));
  const sizes = { name, most: MOST_BYTES / 2 ** 20 };
  if (bytes(files) > MOST_BYTES && files.delete(FIELDS)) notice(say('run_without_fields', sizes));
  if (bytes(files) > MOST_BYTES) return notice(say('run_too_large', sizes));
  const run = await inBase64(files);
  put('lesson', null);
  open({ name, run });
}

/** Opens a case of its text and files. @param {string} name @param {Blob|{size: number, arrayBuffer: () => Promise<ArrayBuffer>}} text @param {Files} [files] */
async function openCase(name, text, files = new Map()) {
  if (text.size + bytes(files) > MOST_BYTES) return notice(say('case_too_large', { name, most: MOST_BYTES / 2 ** 20 }));
  const source = { name, toml: new TextDecoder().decode(await text.arrayBuffer()), files: await inBase64(files) };
  put('lesson', null);
  open(source);
}

/** Opens the case or replays the run of an archive, whose files may lie in a folder. @param {string} name @param {File} archive */
async function openZip(name, archive) {
  const all = await filesOfZip(archive);
  const folder = [...all.keys()].find((path) => path === CASE || path.endsWith(`/${CASE}`))?.slice(0, -CASE.length) ?? '';
  const files = new Map([...all].filter(([path]) => path.startsWith(folder) && !path.endsWith('/')).map(([path, file]) => [path.slice(folder.length), file]));
  const text = files.get(CASE);
  if (!text || files.has(SUMMARY)) return replay(name, files);
  files.delete(CASE);
  return openCase(name, text, files);
}

/** Opens a file with a case or a run; false if it is neither by its name. @param {File} file */
export function openFile(file) {
  const [, name, ending] = /^(.*)\.(zip|toml)$/i.exec(file.name) ?? [];
  if (!ending) return false;
  const opened = ending.toLowerCase() === 'zip' ? openZip(name, file) : openCase(name, file);
  opened.catch(() => notice(say('file_unreadable', { name: file.name })));
  return true;
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
