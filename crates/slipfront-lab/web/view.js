// @ts-check
// How the run is looked at: nothing here changes the case.
import { inAddress } from './address.js';
import { send } from './connection.js';
import { FIELDS } from './frames.js';
import { put, state } from './store.js';

/** @import { ViewChange } from '../types/protocol' */

const calm = matchMedia('(prefers-reduced-motion: reduce)').matches;

/** The field that the address asks for; none if it asks for none that there is. */
const fieldOfAddress = () => FIELDS.find((field) => field === inAddress('field'));

put('view', {
  field: fieldOfAddress() ?? 'front',
  visible: !document.hidden,
  paused: calm,
  pace: 25,
  loading_pace: 0,
  twin: true,
  kymograph: true,
  frames_per_second: 60,
  after_change: 'rest',
  probe: null,
});

/** Whether the page starts paused, since its reader asks for little motion. */
export const startsPaused = calm;

/** Changes a part of the view. @param {ViewChange} part */
export function setView(part) {
  put('view', { ...state.view, ...part });
  send({ do: 'view', ...part });
}

window.addEventListener('hashchange', () => {
  const field = fieldOfAddress();
  if (field) setView({ field });
});

/** Tells a new connection all of it. */
export const sendView = () => send({ do: 'view', ...state.view });
