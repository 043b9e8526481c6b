// @ts-check
// Dialogs: buttons that open and close them; a press beside one closes it.
import { find, make, onPress } from './element.js';
import { say } from './text.js';

const SHORTCUTS = ['space', 'n', 'r', 'undo', 'redo', 'tools', 'arrows', 'enter', 'zoom', 'move', 'size', 'turn', 'delete', 'escape', 'pan', 'help'];

/** Prepares them. */
export function startDialogs() {
  const rows = SHORTCUTS.flatMap((name) => [make('dt', { textContent: say(`key_${name}`) }), make('dd', { textContent: say(`key_${name}_does`) })]);
  find('shortcuts').replaceChildren(...rows);
  onPress('open-help', () => find('help').showModal());
  for (const dialog of document.querySelectorAll('dialog')) {
    dialog.querySelector('.close')?.addEventListener('click', () => dialog.close());
    dialog.addEventListener('click', (event) => {
      if (event.target === dialog) dialog.close();
    });
  }
}
