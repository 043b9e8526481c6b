// @ts-check
// A clip of the field with its colour bar and time, as a WebM file.
import { download, find, onPress } from './element.js';
import { watchField } from './field.js';
import { fieldFigure } from './figure.js';
import { notice } from './notices.js';
import { state } from './store.js';
import { say } from './text.js';

const LONGEST_MS = 60_000;
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
  find('clip').textContent = say('keep_clip_stop');
  find('clip-running').hidden = false;
  return made;
}

function toggle() {
  find('keep').close();
  if (recorder) recorder.stop();
  else if (typeof MediaRecorder === 'undefined' || !MediaRecorder.isTypeSupported('video/webm')) notice(say('no_clip'));
  else recorder = begin();
}

/** Prepares the buttons. */
export function startClip() {
  onPress('clip', toggle);
  onPress('clip-running', toggle);
}
