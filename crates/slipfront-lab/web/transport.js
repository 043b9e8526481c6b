// @ts-check
// Whether and how fast the run goes on, back to rest, undo and redo.
import { send } from './connection.js';
import { find, onPress } from './element.js';
import { number } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';
import { setView, startsPaused } from './view.js';
import { notice } from './notices.js';

/** @import { CaseReply } from '../types/protocol' */

/** Places of the pace slider are steps of a tenth of a decade from this; the last one is as fast as possible. */
const SLOWEST = 0.5;
const LAST = 47;
/** Seconds after which the onset is expected at the pace with which a case opens. */
const ONSET_S = 10 / 3;

/** Whether the reader has asked for full speed, which then holds for every case. */
let fastest = false;
/** The case that was opened last. */
let opened = '';

/** @param {number} place */
const paceOf = (place) => (place >= LAST ? 0 : Number((SLOWEST * 10 ** (place / 10)).toPrecision(2)));
/** @param {number} pace */
const placeOf = (pace) => (pace === 0 ? LAST : Math.round(10 * Math.log10(pace / SLOWEST)));

function showView() {
  const { paused, pace, after_change: after } = state.view;
  const ended = find('pause').disabled;
  find('pause').textContent = say(ended ? 'ended_button' : paused ? 'play' : 'pause');
  find('step').disabled = !paused || ended;
  find('pace').value = String(placeOf(pace));
  const text = pace === 0 ? say('pace_fastest') : say('pace_value', { pace: number(pace) });
  find('pace-value').textContent = text;
  find('pace').setAttribute('aria-valuetext', text);
  find(after === 'rest' ? 'after-rest' : 'after-go-on').checked = true;
  showEffect();
}

function showEffect() {
  const memory = state.case?.has_memory ?? false;
  find('after-go-on').disabled = memory;
  const key = memory ? 'effect_memory' : state.view.after_change === 'rest' ? 'effect_rest' : 'effect_go_on';
  find('effect').textContent = say(key);
}

/** A run that has ended neither goes on nor stops. @param {boolean} ended */
function showEnd(ended) {
  if (find('pause').disabled === ended) return;
  find('pause').disabled = ended;
  showView();
}

/** Gives a case that is opened the pace that suits it; a lesson sets its own. @param {CaseReply} shown */
function suitPace({ why, toml, onset_star: onset }) {
  if (why !== 'open' || toml === opened) return;
  opened = toml;
  if (!fastest && !state.lesson) setView({ pace: paceOf(Math.min(Math.max(placeOf(onset / ONSET_S), 0), LAST - 1)) });
}

/** @param {CaseReply} shown */
function showCase(shown) {
  suitPace(shown);
  find('undo').disabled = !shown.can_undo;
  find('redo').disabled = !shown.can_redo;
  find('case-name').textContent = shown.name;
  showEffect();
}

/** Prepares the buttons. */
export function startTransport() {
  find('pace').max = String(LAST);
  onPress('pause', () => setView({ paused: !state.view.paused }));
  onPress('step', () => send({ do: 'step', count: 1 }));
  onPress('rest', () => send({ do: 'rest' }));
  onPress('undo', () => send({ do: 'undo' }));
  onPress('redo', () => send({ do: 'redo' }));
  find('pace').addEventListener('input', () => {
    const pace = paceOf(find('pace').valueAsNumber);
    fastest = pace === 0;
    setView({ pace });
  });
  find('after-rest').addEventListener('change', () => setView({ after_change: 'rest' }));
  find('after-go-on').addEventListener('change', () => setView({ after_change: 'go_on' }));
  document.addEventListener('visibilitychange', () => setView({ visible: !document.hidden }));
  on('view', showView);
  on('case', showCase);
  on('numbers', ({ ended }) => showEnd(ended));
  showView();
  if (startsPaused) notice(say('starts_paused'));
}
