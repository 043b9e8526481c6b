// @ts-check
// What is kept of a run: a link, the case, a run folder, pictures.
import { isAlone } from './assets.js';
import { fromBase64 } from './base64.js';
import { send } from './connection.js';
import { download, find, make, onPress } from './element.js';
import { drawNow, watchField } from './field.js';
import { curvesFigure, fieldFigure, kymographFigure } from './figure.js';
import { makeLink } from './link.js';
import { announce, notice } from './notices.js';
import { exported } from './session.js';
import { on, state } from './store.js';
import { say } from './text.js';

/** @import { SavedReply, SavingReply } from '../types/protocol' */

const name = () => state.case?.name ?? 'case';

async function copyLink() {
  const { toml, files } = await exported();
  const link = await makeLink({ name: name(), toml, files });
  if (link === null) return notice(say('link_too_long'));
  const address = `${location.href.replace(/#.*/, '')}#case=${link}`;
  history.replaceState(null, '', `#case=${link}`);
  try {
    await navigator.clipboard.writeText(address);
    notice(say(isAlone ? 'link_copied' : 'link_copied_server'));
  } catch {
    notice(say('link_in_address'));
  }
}

async function downloadCase() {
  const { toml, files, zip } = await exported();
  if (Object.keys(files).length > 0) download(new Blob([fromBase64(zip)], { type: 'application/zip' }), `${name()}.zip`);
  else download(new Blob([toml], { type: 'application/toml' }), `${name()}.toml`);
}

/** @param {HTMLCanvasElement} canvas @param {string} panel */
function png(canvas, panel) {
  canvas.toBlob((blob) => blob && download(blob, `${name()}-${panel}.png`), 'image/png');
}

function fieldPng() {
  const [canvas, draw] = fieldFigure(2);
  // The picture is read right after it was drawn: the browser may clear it later.
  const unwatch = watchField(draw);
  drawNow();
  unwatch();
  png(canvas, 'field');
}

/** @param {SubmitEvent} event */
function save(event) {
  event.preventDefault();
  send({ do: 'save', name: find('save-name').value });
  find('keep').close();
}

/** @param {string} name */
function savingRow(name) {
  const label = make('span', { textContent: say('saving_run', { name }) });
  const stop = make('button', { type: 'button', textContent: say('save_stop') });
  stop.addEventListener('click', () => send({ do: 'save_stop', name }));
  const row = make('li', {}, [label, make('progress', { max: 1, 'aria-label': label.textContent }), stop]);
  row.dataset.name = name;
  return row;
}

/** Shows every run that is being saved, also those that another page has begun, or this one before it was loaded again. @param {SavingReply} saving */
function showSaving({ under_way: all }) {
  const list = find('saving');
  const rows = new Map([...list.querySelectorAll('li')].map((row) => [row.dataset.name, row]));
  // A row stays as it is, so that its button keeps the focus.
  for (const { name, share } of all) {
    const row = rows.get(name) ?? list.appendChild(savingRow(name));
    /** @type {HTMLProgressElement} */ (row.querySelector('progress')).value = share;
    rows.delete(name);
  }
  for (const row of rows.values()) row.remove();
  list.hidden = all.length === 0;
}

/** @param {SavedReply} saved */
function showSaved({ folder, folders }) {
  if (state.hello) state.hello.folders = folders;
  notice(say('saved', { folder }));
  announce(say('saved', { folder }));
}

/** Prepares the dialog. */
export function startKeep() {
  onPress('open-keep', () => {
    find('save-name').value = name();
    find('keep').showModal();
  });
  const closing = (/** @type {string} */ id, /** @type {() => void} */ action) => onPress(id, () => {
    find('keep').close();
    action();
  });
  closing('copy-link', copyLink);
  closing('download-case', downloadCase);
  closing('png-field', fieldPng);
  closing('png-curves', () => curvesFigure((canvas) => png(canvas, 'curves')));
  closing('png-kymograph', () => png(kymographFigure(), 'kymograph'));
  find('save-form').addEventListener('submit', save);
  on('saving', showSaving);
  on('saved', showSaved);
  on('hello', ({ results }) => {
    find('save-where').textContent = results === null ? say('save_zip') : say('save_where', { results });
    if (results === null) find('save-label').textContent = say('save_name_zip');
  });
}
