// @ts-check
// The words of the page: all of them stand in en.json.
import { jsonOf } from './assets.js';

/** @import { Words } from '../types/page' */

/** @type {Record<string, string>} */
let words = {};

/** Loads the words; everything else begins after that. */
export async function loadText() {
  words = await jsonOf('en.json');
  document.documentElement.lang = words.language;
}

/** The text of `key`, with every `{name}` in it replaced by the value of that name. @param {string} key @param {Words} [values] */
export function say(key, values = {}) {
  const text = words[key] ?? key;
  return text.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? String(values[name]) : whole));
}

/** Whether there is a text of `key`. @param {string} key */
export const has = (key) => key in words;

/** Puts words into the elements that ask for them: `data-say` for text, `data-label` for the accessible name, `data-hint` for the tooltip. */
export function fillText(root = document) {
  for (const element of root.querySelectorAll('[data-say]')) element.textContent = say(element.getAttribute('data-say') ?? '');
  for (const element of root.querySelectorAll('[data-label]')) element.setAttribute('aria-label', say(element.getAttribute('data-label') ?? ''));
  for (const element of root.querySelectorAll('[data-hint]')) element.setAttribute('title', say(element.getAttribute('data-hint') ?? ''));
  for (const element of root.querySelectorAll('[data-blank]')) element.setAttribute('placeholder', say(element.getAttribute('data-blank') ?? ''));
}
