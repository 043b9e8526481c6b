// @ts-check
// The list of cases to open: searchable, in groups and with small pictures, with the recorded runs of the
// folder of results.
import { fromBase64 } from './base64.js';
import { find, make, onPress } from './element.js';
import { open } from './session.js';
import { on, put, state } from './store.js';
import { say } from './text.js';
import { colour, onTheme } from './theme.js';

/** @import { HelloReply, Source } from '../types/protocol' */

/** Pixels along each side of a small picture, of half a byte each; that of a pixel without contact, and of one without a block. */
const SIZE = 32;
const NO_CONTACT = 0;
const NO_BLOCK = 15;
const GROUPS = ['holes', 'grooves', 'surfaces', 'materials', 'laws', 'sliders', 'paper'];

/** Draws the texture of a case and how its static coefficients differ. @param {string} packed */
function picture(packed) {
  const canvas = make('canvas', { width: SIZE, height: SIZE, 'aria-hidden': 'true' });
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  fromBase64(packed).forEach((byte, k) => {
    [byte >> 4, byte & 15].forEach((value, half) => {
      if (value === NO_BLOCK) return;
      context.fillStyle = value === NO_CONTACT ? colour('textured') : `hsl(210 35% ${20 + 4 * value}%)`;
      context.fillRect((2 * k + half) % SIZE, Math.floor((2 * k) / SIZE), 1, 1);
    });
  });
  return canvas;
}

/** @param {string} title @param {string} hint @param {Source} source @param {string} [packed] its small picture */
function entry(title, hint, source, packed) {
  const words = make('span', {}, [make('strong', { textContent: title }), make('span', { textContent: hint })]);
  const button = make('button', { type: 'button' }, packed ? [picture(packed), words] : [words]);
  button.addEventListener('click', () => {
    put('lesson', null);
    open(source);
    find('presets').close();
  });
  return make('li', {}, [button]);
}

/** The groups: their heading and entries of what matches. @param {string} wanted @returns {Array<[string, HTMLElement[]]>} */
function groups(wanted) {
  const { presets, folders } = /** @type {HelloReply} */ (state.hello);
  const words = wanted.toLowerCase().split(/\s+/);
  const matches = (/** @type {string} */ text) => words.every((word) => text.toLowerCase().includes(word));
  const ofGroup = (/** @type {string} */ group) => presets
    .filter((preset) => preset.group === group && matches(`${preset.name} ${preset.title}`))
    .map(({ name, title, picture: packed }) => entry(name, title, { preset: name }, packed));
  return [
    ...GROUPS.map((group) => /** @type {[string, HTMLElement[]]} */ ([say(`presets_${group}`), ofGroup(group)])),
    [say('presets_folders'), folders.filter(matches).map((name) => entry(name, say('folder_hint'), { folder: name }))],
  ];
}

function show() {
  if (!state.hello) return;
  const found = groups(find('presets-search').value).filter(([, entries]) => entries.length > 0);
  const content = found.flatMap(([heading, entries]) => [make('h3', { textContent: heading }), make('ul', {}, entries)]);
  find('presets-list').replaceChildren(...(content.length > 0 ? content : [make('p', { textContent: say('nothing_found') })]));
}

/** Prepares the list. */
export function startPresets() {
  onPress('open-presets', () => {
    find('presets-search').value = '';
    show();
    find('presets').showModal();
  });
  find('presets-search').addEventListener('input', show);
  find('presets-search').addEventListener('keydown', (/** @type {KeyboardEvent} */ event) => {
    if (event.key !== 'Enter') return;
    event.preventDefault();
    find('presets-list').querySelector('button')?.click();
  });
  // The folders of runs are more then.
  on('saved', show);
  onTheme(() => find('presets').open && show());
}
