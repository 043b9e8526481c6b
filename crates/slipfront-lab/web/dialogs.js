// @ts-check
// Dialogs: buttons that open and close them; a press beside one closes it.
import { find, make, onPress } from './element.js';
import { say } from './text.js';

const SHORTCUTS = ['space', 'n', 'r', 'undo', 'redo', 'tools', 'arrows', 'enter', 'zoom', 'move', 'size', 'turn', 'delete', 'close', 'escape', 'pan', 'help'];

const MEANINGS = ['headline', 'percent', 'static', 'onset', 'kinetic', 'sliding', 'letters', 'front'];

/** @param {string} id @param {string[][]} rows */
const fill = (id, rows) => find(id).replaceChildren(...rows.flatMap(([name, text]) => [make('dt', { textContent: name }), make('dd', { textContent: text })]));

/** Prepares them. */
export function startDialogs() {
  fill('shortcuts', SHORTCUTS.map((name) => [say(`key_${name}`), say(`key_${name}_does`)]));
  fill('meanings', MEANINGS.map((name) => [say(`meaning_${name}`), say(`meaning_${name}_is`)]));
  onPress('open-help', () => find('help').showModal());
  for (const dialog of document.querySelectorAll('dialog')) {
    dialog.querySelector('.close')?.addEventListener('click', () => dialog.close());
    dialog.addEventListener('click', (event) => {
      if (event.target === dialog) dialog.close();
    });
  }
}
