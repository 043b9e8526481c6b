// @ts-check
// What the page knows of the simulation, by topic, and who wants to hear when it changes. Topics are the
// names of the server's messages (`case`, `numbers`, ...) and of what the page decides itself (`view`,
// `tool`, `selected`, ...).

/** @import { State, Topics } from '../types/page' */
/** @import { CaseReply } from '../types/protocol' */

export const state = /** @type {State} */ ({ selected: null });

/** The case that is shown, for what happens only while there is one. */
export const presentCase = () => /** @type {CaseReply} */ (state.case);

/** Each takes the values of its own topic. @type {Map<keyof Topics, Array<(value: never) => void>>} */
const listeners = new Map();

/** Calls `action` whenever `topic` gets a value. @template {keyof Topics} Topic @param {Topic} topic @param {(value: Topics[Topic]) => void} action */
export function on(topic, action) {
  listeners.set(topic, [...(listeners.get(topic) ?? []), action]);
}

/** Gives `topic` a value and calls who listens. @template {keyof Topics} Topic @param {Topic} topic @param {Topics[Topic]} value */
export function put(topic, value) {
  Object.assign(state, { [topic]: value });
  for (const action of listeners.get(topic) ?? []) action(/** @type {never} */ (value));
}

/** The next value of `topic`. @template {keyof Topics} Topic @param {Topic} topic @returns {Promise<Topics[Topic]>} */
export function next(topic) {
  return new Promise((resolve) => {
    const once = (/** @type {Topics[Topic]} */ value) => {
      listeners.set(topic, (listeners.get(topic) ?? []).filter((action) => action !== once));
      resolve(value);
    };
    on(topic, once);
  });
}
