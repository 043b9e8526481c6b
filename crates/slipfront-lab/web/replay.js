// @ts-check
// The recorded snapshots of a run folder.
import { send } from './connection.js';
import { find } from './element.js';
import { fixed } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';

function show() {
  const index = find('replay').valueAsNumber - 1;
  const text = index < 0 ? say('replay_live') : say('replay_at', { t: fixed(state.recorded?.times_star[index], 1) });
  find('replay-value').textContent = text;
  find('replay').setAttribute('aria-valuetext', text);
}

/** Prepares the slider: its first place is the live field. */
export function startReplay() {
  on('recorded', (recorded) => {
    find('replay-row').hidden = !recorded || recorded.times_star.length === 0;
    if (!recorded) return;
    find('replay').max = String(recorded.times_star.length);
    find('replay').value = '0';
    show();
  });
  find('replay').addEventListener('input', () => {
    const index = find('replay').valueAsNumber - 1;
    send({ do: 'frames_of', index: index < 0 ? null : index });
    show();
  });
}
