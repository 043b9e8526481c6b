// @ts-check
// What the page knows of the simulation, by topic, and who wants to hear when it changes. Topics are the names of the server's
// messages (`case`, `numbers`, ...) and of what the page decides itself (`view`, `tool`, `selected`, ...).

/** @type {Record<string, any>} */
export const state = {};

/** @type {Map<string, Array<(value: any) => void>>} */
const listeners = new Map();

/** Calls `action` whenever `topic` gets a value. @param {string} topic @param {(value: any) => void} action */
export function on(topic, action) {
  const list = listeners.get(topic) ?? [];
  list.push(action);
  listeners.set(topic, list);
}

/** Gives `topic` a value and tells it. @param {string} topic @param {any} value */
export function put(topic, value) {
  state[topic] = value;
  for (const action of listeners.get(topic) ?? []) action(value);
}

/** The next value of `topic`. @param {string} topic @returns {Promise<any>} */
export function next(topic) {
  return new Promise((resolve) => {
    const list = listeners.get(topic) ?? [];
    const once = (/** @type {any} */ value) => {
      listeners.set(topic, (listeners.get(topic) ?? []).filter((action) => action !== once));
      resolve(value);
    };
    listeners.set(topic, [...list, once]);
  });
}
