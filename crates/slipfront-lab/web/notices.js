// @ts-check
// Sentences for the reader: what was refused, what failed, whether there is a connection. They can be
// dismissed and are read out.
import { isAlone } from './assets.js';
import { atMost, find, make } from './element.js';
import { fixed } from './quantity.js';
import { on, put, state } from './store.js';
import { say } from './text.js';

const MOST = 4;
/** A sentence that asks for nothing goes away by itself. */
const LONGEST_MS = 20_000;
const ANNOUNCED_MS = 3000;

/** Shows a sentence; one with the same `topic` takes its place. @param {string} text @param {{topic?: string, serious?: boolean}} [options] */
export function notice(text, { topic = text, serious = false } = {}) {
  withdraw(topic);
  const close = make('button', { type: 'button', textContent: say('dismiss') });
  const item = make('p', { className: serious ? 'notice serious' : 'notice' }, [make('span', { textContent: text }), close]);
  item.dataset.topic = topic;
  close.addEventListener('click', () => item.remove());
  const list = find('notices');
  list.append(item);
  if (!serious) setTimeout(() => item.remove(), LONGEST_MS);
  while (list.children.length > MOST) list.firstElementChild?.remove();
}

/** Takes the sentence of a topic away. @param {string} topic */
export function withdraw(topic) {
  for (const item of find('notices').querySelectorAll('p')) if (item.dataset.topic === topic) item.remove();
}

let lost = '';

/** @param {{yes: boolean, ended?: boolean, reason?: string}} connection */
function showConnection({ yes, ended, reason }) {
  document.body.classList.toggle('alone', !yes);
  const before = lost;
  lost = yes ? '' : ended ? say(isAlone ? 'worker_lost' : 'ended') : reason ? say('lost_because', { reason }) : say('lost');
  if (yes) withdraw('connection');
  // It is tried again and again, but the same is told once.
  else if (lost !== before) notice(lost, { topic: 'connection', serious: true });
}

/** Begins to listen. */
export function startNotices() {
  on('connected', showConnection);
  // Below its first line a sentence about a case shows a line of a file that the reader does not see.
  on('refused', ({ of, sentence }) => {
    // Who points at a slider has asked for nothing: what stands below it says enough.
    if (of !== 'sensitivity') notice(sentence.split('\n')[0], { topic: 'refused' });
  });
  on('failed', ({ sentence }) => notice(say('failed', { sentence }), { topic: 'failed', serious: true }));
  on('problem', ({ key, values }) => notice(say(key, values)));
  on('case', ({ warnings, too_coarse: tooCoarse, why }) => {
    // After a refusal the case comes again as it stands.
    if (why === 'refused') return;
    withdraw('failed');
    withdraw('refused');
    withdraw('warnings');
    // What stands beside the shapes lies on nothing.
    const told = warnings.filter((warning) => warning !== tooCoarse);
    // A lesson says itself what its case is for.
    if (told.length > 0 && why === 'open' && !state.lesson) notice(told.join(' '), { topic: 'warnings' });
  });
}

/** Says something to those who listen to the page without seeing it. @param {string} text */
export const announce = (text) => put('announcement', text);

/** Reads announcements out, the newest, and no more than one in some seconds. */
export function startAnnouncements() {
  on('announcement', atMost(() => (find('announcements').textContent = state.announcement ?? ''), ANNOUNCED_MS));
  on('case', ({ why, name, texture_percent: percent }) => {
    if (why !== 'rest' && why !== 'refused') announce(say('tell_case', { name, percent: fixed(percent, 1) }));
  });
}
