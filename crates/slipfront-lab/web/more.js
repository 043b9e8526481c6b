// @ts-check
// Where the header has little room: a button that shows what else it has.
import { find, onPress } from './element.js';

/** Prepares the button. */
export function startMore() {
  onPress('more', () => {
    const shows = document.body.classList.toggle('more');
    find('more').setAttribute('aria-expanded', String(shows));
  });
}
