// @ts-check
// The search for a texture that is better than the painted one: a button, how far it is, and what came of it.
import { send } from './connection.js';
import { newGesture } from './edit.js';
import { find, onPress } from './element.js';
import { redraw } from './field.js';
import { announce, notice } from './notices.js';
import { estimate } from './numbers.js';
import { fixed, quantity } from './quantity.js';
import { on, put, state } from './store.js';
import { say } from './text.js';

/** @import { CaseReply, FindingReply, FoundReply } from '../types/protocol' */

/** @param {CaseReply} shown */
function showLimits({ search: { width_blocks: blocks, most_percent: most }, block_size_m: size }) {
  find('find-limits').textContent = say('find_limits', { percent: fixed(most, 1), blocks, width: quantity(blocks * size, 'm') });
}

/** What is said of a search that is under way. @param {FindingReply} finding */
function progressText({ seconds, of_seconds: of, textures, compares, best_percent: best }) {
  if (compares) return say('finding_compares', { textures });
  const values = { textures, seconds: fixed(seconds, 0), of: fixed(of, 0) };
  return best === null ? say('finding', values) : say('finding_best', { ...values, best: fixed(best, 1) });
}

/** @param {FindingReply|null} finding */
function showProgress(finding) {
  find('find').textContent = say(finding ? 'find_stop' : 'find');
  find('find').disabled = finding?.compares ?? false;
  find('find-progress').hidden = !finding;
  find('find-limits').hidden = finding !== null;
  if (finding) {
    find('find-progress').value = finding.seconds / finding.of_seconds;
    find('found').textContent = progressText(finding);
  }
  redraw();
}

/** @param {FoundReply} found */
function show({ outcome, textures, surfaces, best, painted }) {
  put('finding', null);
  find('found').textContent = '';
  if (outcome === 'given_up') notice(say('found_given_up'));
  if (outcome === 'given_up' || outcome === 'failed') return;
  const where = surfaces > 1 ? say('found_fresh', { surfaces }) : say('found_alike');
  const text = say(`found_${outcome}${painted ? '' : '_plain'}`, { best: estimate(best, 2), painted: estimate(painted, 2), textures, on: where });
  find('found').textContent = text;
  announce(text);
}

/** Prepares the button. */
export function startFind() {
  const give = () => put('finding', null);
  onPress('find', () => (state.finding ? send({ do: 'find_stop' }) : send({ do: 'find', gesture: newGesture() })));
  on('case', (shown) => {
    showLimits(shown);
    if (shown.why !== 'rest' && shown.why !== 'refused') find('found').textContent = '';
  });
  on('finding', showProgress);
  on('found', show);
  on('failed', give);
  on('connected', give);
  showProgress(null);
}
