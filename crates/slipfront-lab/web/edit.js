// @ts-check
// Changes of the case. What belongs to one gesture of the reader is one step of undo.
import { send } from './connection.js';

/** @import { CaseKeys } from '../types/protocol' */

/** Between two changes of one gesture: more often than this nobody sees a difference. */
const SPACING_MS = 50;

let gestures = 0;

/** The number of a new gesture. */
export const newGesture = () => ++gestures;

/** Changes keys of the case at once. @param {CaseKeys} keys */
export const change = (keys, gesture = newGesture()) => send({ do: 'set', keys, gesture });

/** Changes of keys that belong to one gesture, of which only the newest is sent, and no more than one in `SPACING_MS`. */
export function gradual() {
  const gesture = newGesture();
  /** @type {CaseKeys|null} */
  let waiting = null;
  let sentAt = -Infinity;
  let timer = 0;
  const flush = () => {
    clearTimeout(timer);
    timer = 0;
    if (!waiting) return;
    change(waiting, gesture);
    waiting = null;
    sentAt = performance.now();
  };
  return {
    /** @param {CaseKeys} keys */
    change(keys) {
      waiting = keys;
      if (!timer) timer = window.setTimeout(flush, Math.max(0, sentAt + SPACING_MS - performance.now()));
    },
    end: flush,
  };
}
