// @ts-check
// What to try next: a hole at first, and at the end of a run what it has found and three ways on.
import { find, onPress } from './element.js';
import { fixed } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';
import { chooseTool } from './tools.js';

/** @import { NumbersReply } from '../types/protocol' */

/** What a run has found, in a sentence. @param {NumbersReply} numbers */
function found({ peak, change_percent: change }) {
  if (!peak) return say('next_ended');
  const values = { mu: fixed(peak.mu_star), change: `${(change ?? 0) > 0 ? '+' : ''}${fixed(change, 1)} %` };
  return say(!peak.certain ? 'next_no_peak' : change === null ? 'next_found' : 'next_found_change', values);
}

/** @param {NumbersReply} numbers */
function show(numbers) {
  find('next-buttons').hidden = !numbers.ended;
  find('next-text').textContent = numbers.ended ? found(numbers) : say(state.case?.texture_percent ? 'next_try_more' : 'next_try');
}

/** Prepares the buttons. */
export function startNext() {
  onPress('next-paint', () => {
    chooseTool('brush');
    find('tool-brush').focus();
  });
  onPress('next-repeat', () => find('repeat').click());
  onPress('next-find', () => find('find').click());
  on('numbers', show);
}
