// @ts-check
// Elements of the page, found and made.

/** @import { Elements } from '../types/page' */

/**
 * The element with an id that index.html has, or that was made with it.
 * @template {string} Id @param {Id} id
 */
export const find = (id) => /** @type {Id extends keyof Elements ? Elements[Id] : HTMLElement} */ (document.getElementById(id));

/**
 * Makes an element. Properties are set as such, attributes with a dash or `role` as attributes.
 * @template {keyof HTMLElementTagNameMap} Name
 * @param {Name} name @param {Record<string, string|number|boolean>} [properties] @param {Array<Node|string>} [content]
 */
export function make(name, properties = {}, content = []) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key.includes('-') || key === 'role' || key === 'for') element.setAttribute(key, String(value));
    else Object.assign(element, { [key]: value });
  }
  element.append(...content);
  return element;
}

/** Writes into a text field. Where it has the focus all of it is then selected, as after Tab, so that typing replaces it. @param {HTMLInputElement} field @param {string} text */
export function rewrite(field, text) {
  if (field.value === text) return;
  field.value = text;
  if (document.activeElement === field) field.select();
}

/** Calls `action` when the element with this id is pressed. @param {string} id @param {() => void} action */
export const onPress = (id, action) => find(id).addEventListener('click', action);

/** Offers a file to be saved. @param {Blob} blob @param {string} name */
export function download(blob, name) {
  const address = URL.createObjectURL(blob);
  make('a', { href: address, download: name }).click();
  // The browser reads the address after this function has returned.
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** Calls `action` at most once in `spacing` milliseconds, the last call always. @param {() => void} action @param {number} spacing */
export function atMost(action, spacing) {
  let timer = 0;
  let at = -Infinity;
  return () => {
    if (timer) return;
    timer = window.setTimeout(() => {
      timer = 0;
      at = performance.now();
      action();
    }, Math.max(0, at + spacing - performance.now()));
  };
}
