// @ts-check
// What the block under the pointer has.
import { find, make } from './element.js';
import { camera } from './field.js';
import { fixed, quantity } from './quantity.js';
import { on, state } from './store.js';
import { say } from './text.js';

/** @import { ProbeReply } from '../types/protocol' */

/** The lines of a block: what it is called and what it has. @param {ProbeReply} probe @returns {Array<[string, string]>} */
function lines(probe) {
  if (!probe.exists) return [[say('probe_state'), say('probe_no_block')]];
  if (probe.textured) return [[say('probe_state'), say('probe_textured')]];
  const first = probe.first_slip_star;
  return [
    [say('probe_state'), say(probe.sliding ? 'probe_sliding' : 'probe_stuck')],
    [say('probe_mu_static'), fixed(probe.mu_static)],
    [say('probe_mu_kinetic'), fixed(probe.mu_kinetic)],
    [say('field_contact_stress'), quantity(probe.contact_stress_pa, 'Pa')],
    [say('field_traction'), quantity(probe.traction_pa, 'Pa')],
    [say('field_displacement'), quantity(probe.displacement_m, 'm')],
    [say('field_speed'), quantity(probe.speed_m_s, 'm/s')],
    [say('field_first_slip'), first === null ? say('probe_never') : fixed(first, 1)],
  ];
}

/** @param {ProbeReply} probe */
function show(probe) {
  const [i, j] = probe.block;
  find('probe').hidden = false;
  // It does not cover the block that it tells of.
  const [x, y] = camera.toPixels(probe.block);
  find('probe').classList.toggle('right', x < camera.pixels[0] / 2 && y > camera.pixels[1] / 2);
  find('probe-block').textContent = say('probe_block', { i, j });
  find('probe-values').replaceChildren(...lines(probe).flatMap(([name, value]) => [make('dt', { textContent: name }), make('dd', { textContent: value })]));
}

/** Begins to listen. */
export function startProbe() {
  on('probe', show);
  on('view', () => {
    if (!state.view.probe) find('probe').hidden = true;
  });
}
