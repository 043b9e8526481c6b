// @ts-check
// Lessons: a text beside the running simulation, with buttons that change it. Their structure stands in
// lessons.json, their words in lessons.en.json, every number of a text in lesson_numbers.json.
import { inAddress } from './address.js';
import { jsonOf, textOf } from './assets.js';
import { change } from './edit.js';
import { find, make, onPress } from './element.js';
import { readRecord } from './measurement.js';
import { notice } from './notices.js';
import { open } from './session.js';
import { next, on, put, state } from './store.js';
import { say } from './text.js';
import { setView, startsPaused } from './view.js';

/** @import { Lesson, LessonPlace, LessonStep, LessonWords } from '../types/page' */

/** t* in a second until a block in contact slips: before, maps of a lesson have one colour. */
const LOADING_PACE = 60;

/** @type {Lesson[]} */
let lessons = [];
/** @type {Record<string, LessonWords>} */
let words = {};
/** @type {Record<string, {says: string}>} */
let numbers = {};

/** The lesson of this id. @param {string} wanted */
const lessonOf = (wanted) => /** @type {Lesson} */ (lessons.find(({ id }) => id === wanted));

/** A text with its numbers, which no line break parts from their units. @param {string} text */
const withNumbers = (text) => text.replace(/\{(\w+)\}/g, (whole, id) => numbers[id]?.says.replaceAll(' ', '\u00a0') ?? whole);

/** A text with the star of symbols as the rest of the page writes it: in the file another sign keeps it apart from emphasis. @param {string} text */
const withStars = (text) => text.replaceAll('\u2217', '*');

/** A text as it is shown. @param {string} text */
const told = (text) => withStars(withNumbers(text));

/** A paragraph, in which `*words*` are emphasised. @param {string} text */
function paragraph(text) {
  const parts = withNumbers(text).split(/\*([^*]+)\*/).map(withStars);
  return make('p', {}, parts.map((part, k) => (k % 2 === 1 ? make('em', { textContent: part }) : part)));
}

/** Reads the measured record of a step. @param {string} file */
async function loadRecord(file) {
  const text = await textOf(file);
  if (text === null) return notice(say('lesson_missing', { file }));
  readRecord(file.replace(/^.*\//, ''), new TextEncoder().encode(text));
}

/** @param {LessonStep} step @param {Record<string, string>} labels */
function buttons(step, labels) {
  const { record } = step;
  const ofRecord = record === undefined ? [] : [make('button', { type: 'button', textContent: say('lesson_record') })];
  ofRecord.forEach((button) => button.addEventListener('click', () => loadRecord(record ?? '')));
  const ofCase = (step.set ?? []).map((button) => {
    const element = make('button', { type: 'button', textContent: told(labels[button.id]) });
    element.addEventListener('click', () => {
      if (button.view) setView(button.view);
      if (button.keys && Object.keys(button.keys).length > 0) change(button.keys);
    });
    return element;
  });
  return [...ofRecord, ...ofCase];
}

/** Loads the case of a step and sets the view. @param {LessonStep} step */
async function prepare(step) {
  const toml = await textOf(step.case);
  if (toml === null) return notice(say('lesson_missing', { file: step.case }));
  setView({ twin: false, after_change: 'rest', paused: startsPaused, loading_pace: LOADING_PACE, ...step.view });
  open({ name: step.case.replace(/^.*\/|\.toml$/g, ''), toml, files: {} });
}

/** @param {LessonPlace|null} place */
function show(place) {
  const left = !find('lesson').hidden && place === null;
  find('lesson').hidden = place === null;
  document.body.classList.toggle('lesson', place !== null);
  if (left) setView({ twin: true, loading_pace: 0 });
  if (!place) return;
  const lesson = lessonOf(place.lesson);
  handout(lesson);
  const step = lesson.steps[place.step];
  const said = words[lesson.id];
  const text = said.steps[step.id];
  find('lesson-title').textContent = told(said.title);
  find('lesson-step').textContent = say('lesson_step', { step: place.step + 1, of: lesson.steps.length, title: told(text.title) });
  find('lesson-text').replaceChildren(...text.text.map(paragraph));
  find('lesson-buttons').replaceChildren(...buttons(step, text.set ?? {}));
  find('lesson-answer').open = false;
  find('lesson-answer-text').replaceChildren(...text.answer.map(paragraph));
  find('lesson-previous').disabled = place.step === 0;
  find('lesson-next').textContent = say(place.step + 1 < lesson.steps.length ? 'lesson_next' : 'lesson_end');
  find('lesson').scrollTop = 0;
  find('lesson').scrollIntoView({ block: 'nearest' });
  find('lesson-step').focus();
  prepare(step);
}

/** The whole lesson for a sheet of paper: all steps with their questions, the answers at the end. @param {Lesson} lesson */
function handout({ id, steps }) {
  const { title, summary, steps: texts } = words[id];
  const step = (/** @type {LessonStep} */ { id: name, set }, /** @type {number} */ k) => {
    const { title: heading, text, set: labels } = texts[name];
    const tries = (set ?? []).map(({ id: button }) => make('li', { textContent: told(labels?.[button] ?? '') }));
    return make('section', {}, [make('h2', { textContent: `${k + 1}  ${told(heading)}` }), ...text.map(paragraph), make('ul', {}, tries)]);
  };
  const answers = steps.map(({ id: name }) => make('li', {}, texts[name].answer.map(paragraph)));
  find('handout').replaceChildren(
    make('h1', { textContent: told(title) }),
    make('p', { textContent: told(summary) }),
    ...steps.map(step),
    make('section', {}, [make('h2', { textContent: say('handout_answers') }), make('ol', {}, answers)]),
  );
}

/** @param {number} by */
function turnPage(by) {
  const { lesson, step } = /** @type {LessonPlace} */ (state.lesson);
  const count = lessonOf(lesson).steps.length;
  put('lesson', step + by < count ? { lesson, step: step + by } : null);
}

function list() {
  const entries = lessons.map(({ id }) => {
    const { title, minutes, summary } = words[id];
    const button = make('button', { type: 'button' }, [make('span', {}, [make('strong', { textContent: told(title) }), make('span', { textContent: say('lesson_summary', { minutes, summary: told(summary) }) })])]);
    button.addEventListener('click', () => {
      find('lessons').close();
      put('lesson', { lesson: id, step: 0 });
    });
    return make('li', {}, [button]);
  });
  find('lessons-list').replaceChildren(...entries);
}

/** Begins the lesson that the address names, by its number or its id. */
function ofAddress() {
  const wanted = inAddress('lesson');
  if (!wanted) return;
  const lesson = lessons[Number(wanted) - 1] ?? lessons.find(({ id }) => id === wanted);
  if (lesson) return put('lesson', { lesson: lesson.id, step: 0 });
  put('problem', { key: 'broken_link' });
  open({});
}

/** Loads the lessons and prepares their list; the page does without them if they are not there. */
export async function startLessons() {
  on('lesson', show);
  onPress('open-lessons', () => find('lessons').showModal());
  onPress('lesson-previous', () => turnPage(-1));
  onPress('lesson-next', () => turnPage(1));
  onPress('lesson-close', () => put('lesson', null));
  try {
    [lessons, words, numbers] = await Promise.all(['lessons.json', `lessons.${say('language')}.json`, 'lesson_numbers.json'].map(jsonOf));
    list();
  } catch {
    find('open-lessons').hidden = true;
  }
  if (!state.hello) await next('hello');
  ofAddress();
  window.addEventListener('hashchange', ofAddress);
}
