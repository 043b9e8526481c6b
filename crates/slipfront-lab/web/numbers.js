// @ts-check
// The numbers of the run: static friction against the slider without texture, live; and those of the summary
// at its end.
import { send } from './connection.js';
import { find, make, onPress } from './element.js';
import { announce } from './notices.js';
import { fixed, number, quantity } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';

/** @import { Estimate, NumbersReply, PeakReply, RepeatedReply, Summary } from '../types/protocol' */

/** @param {number|null|undefined} percent */
const signed = (percent, digits = 1) => (percent === null || percent === undefined ? '\u2013' : `${percent > 0 ? '+' : ''}${fixed(percent, digits)} %`);

/** Rows of a table of names and values, some with a hint. @param {string} id @param {Array<[string, string, string?]>} rows */
function fill(id, rows) {
  const list = find(id);
  if (list.children.length === 2 * rows.length) {
    rows.forEach(([name, value], k) => {
      // Text that is the same is not set again: a selection in it stays.
      if (list.children[2 * k].textContent !== name) list.children[2 * k].textContent = name;
      if (list.children[2 * k + 1].textContent !== value) list.children[2 * k + 1].textContent = value;
    });
  } else {
    list.replaceChildren(...rows.flatMap(([name, value, title = '']) => [make('dt', { textContent: name, title }), make('dd', { textContent: value, title })]));
  }
}

/** A mean with the half width of its interval, if it has one. @param {Estimate|null} sample */
export const estimate = (sample, digits = 3) => (sample === null || sample.half_width === null ? fixed(sample?.mean, digits) : `${fixed(sample.mean, digits)} \u00b1 ${fixed(sample.half_width, digits)}`);

/** A peak, with a tilde while it may still rise. @param {PeakReply|null} peak @param {'t_star'|'mu_star'} key */
const peakValue = (peak, key, digits = 3) => (peak ? `${peak.certain ? '' : '\u2248 '}${fixed(peak[key], digits)}` : '\u2013');

/** @param {NumbersReply} numbers */
function showHeadline({ peak, twin_peak: twin, change_percent: change, ended }) {
  const certain = Boolean(peak?.certain && (change === null || twin?.certain));
  const against = change !== null && change !== undefined;
  find('headline').textContent = against ? signed(change) : peakValue(peak, 'mu_star');
  find('headline-name').textContent = say(against ? 'headline_change' : 'headline_static');
  const note = peak ? (certain ? 'certain' : ended ? 'no_transition' : state.case?.twin ? 'preliminary_twin' : 'preliminary') : (state.case?.leg ?? 0) > 0 ? 'not_from_rest' : 'no_peak_yet';
  find('headline-note').textContent = say(note);
  find('headline').classList.toggle('preliminary', !certain);
}

/** @param {NumbersReply} numbers */
function showRows(numbers) {
  const { peak, twin_peak: twin } = numbers;
  fill('numbers', [
    [say('number_static'), peakValue(peak, 'mu_star')],
    [say('number_without'), peakValue(twin, 'mu_star'), say('number_without_hint')],
    [say('number_onset'), peakValue(peak, 't_star', 1)],
    [say('number_kinetic'), fixed(numbers.kinetic)],
    [say('number_mu'), fixed(numbers.mu_star)],
    [say('number_sliding'), `${fixed(numbers.sliding_percent, 1)} %`, say('meaning_sliding_is')],
    [say('number_time'), `${fixed(numbers.t_star, 1)} = ${quantity(numbers.time_s, 's')}`],
    [say('number_texture'), `${fixed(state.case?.texture_percent, 1)} %`],
    [say('number_pace'), number(numbers.steps_per_second)],
  ]);
}

/** @param {Summary|null} summary */
function showSummary(summary) {
  find('summary').hidden = !summary;
  if (!summary) return;
  const { front_speed_c_s: share, front_speed_m_s: speed } = summary;
  fill('summary-values', [
    [say('summary_static'), `${summary.transition ? '' : '\u2265 '}${fixed(summary.static_friction_star, 4)}`],
    [say('summary_onset'), fixed(summary.onset_time_star, 1)],
    [say('summary_kinetic'), fixed(summary.kinetic_friction_star, 4)],
    [say('summary_front'), share === null || speed === null ? '\u2013' : say('summary_front_value', { share: number(share), speed: quantity(speed, 'm/s') }), say('meaning_front_is')],
    [say('summary_duration'), fixed(summary.front_duration_star, 1)],
    [say('summary_sites'), String(summary.nucleation_sites ?? '\u2013')],
    [say('summary_energy'), number(summary.energy_error)],
  ]);
}

let told = '';

/** Says what has become certain. @param {NumbersReply} numbers */
function tell({ peak, change_percent: change, ended, kinetic }) {
  let text = '';
  if (ended) text = say('tell_ended', { kinetic: fixed(kinetic) });
  else if (peak?.certain) text = change === null || change === undefined ? say('tell_peak', { mu: fixed(peak.mu_star) }) : say('tell_change', { mu: fixed(peak.mu_star), change: signed(change) });
  if (text && text !== told) announce(text);
  told = text;
}

/** @param {NumbersReply} numbers */
function show(numbers) {
  showHeadline(numbers);
  showRows(numbers);
  showSummary(numbers.ended ? numbers.summary : null);
  tell(numbers);
}

/** Shows whether static friction is being computed over seeds. @param {boolean} is */
function showRepeating(is) {
  find('repeat-progress').hidden = !is;
  find('repeat').textContent = say(is ? 'repeat_stop' : 'repeat');
  find('repeat').dataset.busy = is ? 'yes' : '';
}

/** @param {RepeatedReply} repeated */
function showRepeated({ done, of, finished, change_percent: change, with: textured, without, without_transition: creeping }) {
  showRepeating(!finished);
  find('repeat-progress').max = of;
  find('repeat-progress').value = done;
  const text = change
    ? say('repeated_change', { change: estimate(change, 1), with: estimate(textured), without: estimate(without), done })
    : textured ? say('repeated_plain', { with: estimate(textured), done }) : say('repeated_none', { done, of });
  const note = state.case?.seeds ? say('repeated_note', { sentence: state.case.seeds }) : '';
  find('repeated').textContent = [text, creeping ? say('repeated_creeping', { creeping }) : '', finished ? note : ''].filter(Boolean).join(' ');
  if (finished) announce(text);
}

/** Prepares the numbers. */
export function startNumbers() {
  on('numbers', show);
  on('repeated', showRepeated);
  // A session that begins anew computes nothing yet.
  on('hello', () => showRepeating(false));
  onPress('repeat', () => send({ do: 'repeat', seeds: find('repeat').dataset.busy ? 0 : find('repeat-seeds').valueAsNumber }));
  on('case', ({ why, mesh }) => {
    find('mesh-sentence').textContent = say('mesh_sentence', { sentence: mesh.replaceAll('`', '').replace(/(\d) um\b/g, '$1 \u00b5m') });
    if (why !== 'rest') find('repeated').textContent = '';
  });
}
