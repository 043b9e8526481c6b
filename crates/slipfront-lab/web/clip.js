// @ts-check
// A clip of the field with its colour bar and time, as a WebM file. A run that has ended begins again for it.
import { send } from './connection.js';
import { download, find, onPress } from './element.js';
import { drawNow, watchField } from './field.js';
import { fieldFigure } from './figure.js';
import { notice } from './notices.js';
import { on, state } from './store.js';
import { say } from './text.js';

const LONGEST_MS = 60_000;
/** Before it a recorder may not have one picture yet; the last one is shown for so long, too. */
const SHORTEST_MS = 1000;
const PICTURES_PER_SECOND = 30;
const BITS_PER_SECOND = 8_000_000;

/** @type {MediaRecorder|null} */
let recorder = null;

function begin() {
  const [canvas, draw] = fieldFigure(1);
  const unwatch = watchField(draw);
  /** @type {Blob[]} */
  const parts = [];
  const made = new MediaRecorder(canvas.captureStream(PICTURES_PER_SECOND), { mimeType: 'video/webm', videoBitsPerSecond: BITS_PER_SECOND });
  const timer = setTimeout(() => made.stop(), LONGEST_MS);
  made.ondataavailable = ({ data }) => parts.push(data);
  made.onstop = () => {
    clearTimeout(timer);
    unwatch();
    recorder = null;
    find('clip').textContent = say('keep_clip');
    find('clip-running').hidden = true;
    download(new Blob(parts, { type: 'video/webm' }), `${state.case?.name ?? 'slipfront'}.webm`);
  };
  made.start(1000);
  if (state.numbers?.ended) send({ do: 'rest' });
  // What stands still is drawn no more.
  drawNow();
  find('clip').textContent = say('keep_clip_stop');
  find('clip-running').hidden = false;
  return made;
}

/** Ends the clip that is being recorded, if there is one. */
function finish() {
  const ending = recorder;
  setTimeout(() => ending?.state === 'recording' && ending.stop(), SHORTEST_MS);
}

function toggle() {
  find('keep').close();
  if (recorder) finish();
  else if (typeof MediaRecorder === 'undefined' || !MediaRecorder.isTypeSupported('video/webm')) notice(say('no_clip'));
  else recorder = begin();
}

/** Prepares the buttons. */
export function startClip() {
  let ended = false;
  on('numbers', (numbers) => {
    if (numbers.ended && !ended) finish();
    ended = numbers.ended;
  });
  onPress('clip', toggle);
  onPress('clip-running', toggle);
}
