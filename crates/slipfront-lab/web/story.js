// @ts-check
// One line above the field: what is seen there. While a case that was opened goes through its transition, the
// run stands still for a moment at the first slip, at the peak and when the front has crossed, and the line
// says so.
import { find, onPress } from './element.js';
import { announce } from './notices.js';
import { quantity } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';
import { setView, startsPaused } from './view.js';

/** @import { CaseReply, NumbersReply } from '../types/protocol' */

const HOLD_MS = 2500;
/** The key under which the browser keeps that nothing shall stop a run. */
const OFF = 'no-pauses';
/** The sentences of the stages of a transition, and whether the run has reached them. @type {Record<string, (numbers: NumbersReply) => boolean>} */
const STAGES = {
  first_slip: ({ instants }) => 'B' in instants,
  peak: ({ peak }) => Boolean(peak?.certain),
  crossed: ({ crossed }) => crossed,
};

/** Stages at which the run is still to stop. @type {string[]} */
let ahead = [];
let holding = 0;

/** Whither the slider is pulled. @param {number|null} degrees */
function pull(degrees) {
  if (degrees === null) return say('story_turned');
  const turned = ((degrees % 360) + 360) % 360;
  const side = ['right', 'up', 'left', 'down'][turned / 90];
  return side ? say(`story_${side}`) : say('story_angle', { degrees });
}

function show() {
  if (!state.case || holding) return;
  const { blocks, block_size_m: size, drive_degrees: degrees } = state.case;
  find('story-off').hidden = true;
  find('story').classList.remove('caption');
  find('story-text').textContent = say('story', { width: quantity(blocks[0] * size, 'm'), pull: pull(degrees), seen: say(`seen_${state.view.field}`) });
}

/** Goes on after a stop, if the run stands still for one. */
function release() {
  if (!holding) return;
  clearTimeout(holding);
  holding = 0;
  if (state.view.paused) setView({ paused: false });
  show();
}

/** @param {string} stage */
function hold(stage) {
  clearTimeout(holding);
  holding = window.setTimeout(release, HOLD_MS);
  find('story').classList.add('caption');
  find('story-text').textContent = say(`caption_${stage}`);
  find('story-off').hidden = false;
  announce(say(`caption_${stage}`));
  setView({ paused: true });
}

/** @param {NumbersReply} numbers */
function follow(numbers) {
  const reached = ahead.filter((stage) => STAGES[stage](numbers));
  if (reached.length === 0) return;
  ahead = ahead.filter((stage) => !reached.includes(stage));
  // A run that goes as fast as it can, or was stopped by hand, is left alone.
  if (state.view.pace > 0 && (!state.view.paused || holding)) hold(/** @type {string} */ (reached.at(-1)));
}

/** @param {CaseReply} shown */
function begin({ why }) {
  release();
  const isToldElsewhere = startsPaused || state.lesson || localStorage.getItem(OFF) !== null;
  ahead = why === 'open' && !isToldElsewhere ? Object.keys(STAGES) : [];
  show();
}

/** Begins to listen. */
export function startStory() {
  on('case', begin);
  on('numbers', follow);
  on('view', ({ paused }) => {
    // Somebody has pressed Play.
    if (holding && !paused) release();
    show();
  });
  onPress('story-off', () => {
    localStorage.setItem(OFF, 'yes');
    ahead = [];
    release();
  });
}
