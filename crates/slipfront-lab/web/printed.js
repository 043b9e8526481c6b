// @ts-check
// What a printed page has beside the field, the numbers and the curves: every parameter, and the case file.
import { find, make } from './element.js';
import { number, quantity } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';

/** @import { CaseReply } from '../types/protocol' */

/** Names and values of the parameters. @param {CaseReply} shown @returns {Array<[string, string]>} */
function parameters({ values, blocks, block_size_m: size, dt_star: step, duration_star: duration, units, texture_percent: percent }) {
  const controls = (state.hello?.controls ?? []).map(({ id, unit, key, si_key: siKey }) => {
    const { star, si } = values[id];
    const inUnits = si === null ? '' : quantity(si, unit, 6);
    const value = si === null ? `${number(star, 6)} ${unit}` : key === siKey ? inUnits : `${number(star, 6)} = ${inUnits}`;
    return /** @type {[string, string]} */ ([say(`control_${id}`), value]);
  });
  const time = (/** @type {number} */ star) => `${number(star, 6)} = ${quantity(star * units.time_s, 's', 6)}`;
  return [
    ...controls,
    [say('printed_blocks'), say('printed_blocks_of', { nx: blocks[0], ny: blocks[1], size: quantity(size, 'm', 6) })],
    [say('printed_step'), time(step)],
    [say('printed_duration'), time(duration)],
    [say('number_texture'), `${number(percent, 6)} %`],
  ];
}

/** Begins to listen. */
export function startPrinted() {
  on('case', (shown) => {
    find('printed-values').replaceChildren(...parameters(shown).flatMap(([name, value]) => [make('dt', { textContent: name }), make('dd', { textContent: value })]));
    find('printed-case').textContent = shown.toml;
  });
}
