// @ts-check
// The list of cases to open: searchable, in groups, with the recorded runs of the folder of results.
import { find, make, onPress } from './element.js';
import { open } from './session.js';
import { on, put, state } from './store.js';
import { say } from './text.js';

/** @import { HelloReply, Source } from '../types/protocol' */

/** @param {string} title @param {string} hint @param {Source} source */
function entry(title, hint, source) {
  const button = make('button', { type: 'button' }, [make('strong', { textContent: title }), make('span', { textContent: hint })]);
  button.addEventListener('click', () => {
    put('lesson', null);
    open(source);
    find('presets').close();
  });
  return make('li', {}, [button]);
}

/** The groups: key of their heading and entries of what matches. @param {string} wanted @returns {Array<[string, HTMLElement[]]>} */
function groups(wanted) {
  const { presets, folders } = /** @type {HelloReply} */ (state.hello);
  const words = wanted.toLowerCase().split(/\s+/);
  const matches = (/** @type {string} */ text) => words.every((word) => text.toLowerCase().includes(word));
  const ofGroup = (/** @type {string} */ group) => presets
    .filter((preset) => preset.group === group && matches(`${preset.name} ${preset.title}`))
    .map(({ name, title }) => entry(name, title, { preset: name }));
  return [
    ['presets_cases', ofGroup('cases')],
    ['presets_paper', ofGroup('paper')],
    ['presets_folders', folders.filter(matches).map((name) => entry(name, say('folder_hint'), { folder: name }))],
  ];
}

function show() {
  const found = groups(find('presets-search').value).filter(([, entries]) => entries.length > 0);
  const content = found.flatMap(([key, entries]) => [make('h3', { textContent: say(key) }), make('ul', {}, entries)]);
  find('presets-list').replaceChildren(...(content.length > 0 ? content : [make('p', { textContent: say('nothing_found') })]));
}

/** Prepares the list. */
export function startPresets() {
  onPress('open-presets', () => {
    find('presets-search').value = '';
    if (state.hello) show();
    find('presets').showModal();
  });
  find('presets-search').addEventListener('input', show);
  find('presets-search').addEventListener('keydown', (/** @type {KeyboardEvent} */ event) => {
    if (event.key !== 'Enter') return;
    event.preventDefault();
    find('presets-list').querySelector('button')?.click();
  });
  on('hello', show);
  // The folders of runs are more then.
  on('saved', show);
}
