// @ts-check
// Light, dark, or as the system has it; and colours of the style sheet for what is drawn on a canvas.
import { on, put } from './store.js';
import { say } from './text.js';

const CHOICES = ['auto', 'light', 'dark'];
const sample = document.createElement('span');
sample.hidden = true;

/** @type {Map<string, string>} */
const known = new Map();

/** The colour that the style sheet calls `--name` at present. @param {string} name */
export function colour(name) {
  let value = known.get(name);
  if (value === undefined) {
    sample.style.color = `var(--${name})`;
    value = getComputedStyle(sample).color;
    known.set(name, value);
  }
  return value;
}

/** @param {string} choice */
function apply(choice) {
  document.documentElement.dataset.theme = choice;
  localStorage.setItem('theme', choice);
  const button = document.getElementById('theme');
  if (button) button.textContent = say(`theme_${choice}`);
  known.clear();
  put('theme', choice);
}

/** Shows the theme that was chosen last, and follows the switch and the system. */
export function startTheme() {
  document.body.append(sample);
  const stored = localStorage.getItem('theme') ?? '';
  let choice = CHOICES.includes(stored) ? stored : 'auto';
  apply(choice);
  document.getElementById('theme')?.addEventListener('click', () => {
    choice = CHOICES[(CHOICES.indexOf(choice) + 1) % CHOICES.length];
    apply(choice);
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => apply(choice));
}

/** By how much letters of the page are larger than those of a small screen: on canvases they grow as elsewhere. */
export const enlargement = () => parseFloat(getComputedStyle(document.documentElement).fontSize) / 14;

/** Draws anew when the colours have changed. @param {() => void} draw */
export const onTheme = (draw) => on('theme', draw);
