// @ts-check
// Pointer, wheel and fingers on the field: one pointer works with the tool, two move and enlarge the picture.
import { camera, redraw } from './field.js';
import { find } from './element.js';

/** @typedef {{begin(point: number[], event: PointerEvent): boolean, move(point: number[]): void, end(): void, cancel(): void, hover(point: number[]|null): void, leave(): void}} Hand `begin` tells whether the tool takes the drag; else it pans */

/** @param {PointerEvent|WheelEvent} event */
function pixel(event) {
  const { left, top } = find('frame').getBoundingClientRect();
  return [event.clientX - left, event.clientY - top];
}

/** @param {number[]} a @param {number[]} b */
const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);
/** @param {number[]} a @param {number[]} b */
const between = (a, b) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];

/** Leads the pointers to the tool. @param {Hand} hand */
export function startPointer(hand) {
  const frame = find('frame');
  /** @type {Map<number, number[]>} */
  const down = new Map();
  /** @type {'tool'|'pan'|'none'} */
  let mode = 'none';

  frame.addEventListener('pointerdown', (/** @type {PointerEvent} */ event) => {
    if (/** @type {Element} */ (event.target).closest('button')) return;
    frame.setPointerCapture(event.pointerId);
    down.set(event.pointerId, pixel(event));
    if (down.size === 2) {
      if (mode === 'tool') hand.cancel();
      mode = 'pan';
    } else if (down.size === 1) {
      const pans = event.button === 1 || event.shiftKey || !hand.begin(camera.toBlocks(pixel(event)), event);
      mode = pans ? 'pan' : 'tool';
    }
  });

  frame.addEventListener('pointermove', (/** @type {PointerEvent} */ event) => {
    const to = pixel(event);
    const from = down.get(event.pointerId);
    hand.hover(camera.toBlocks(to));
    if (!from) return;
    if (mode === 'tool') {
      // A fast stroke has more points than the browser draws pictures.
      const events = event.getCoalescedEvents?.() ?? [];
      for (const each of events.length > 0 ? events : [event]) hand.move(camera.toBlocks(pixel(each)));
    } else if (down.size === 2) {
      const other = [...down].find(([id]) => id !== event.pointerId)?.[1] ?? to;
      camera.enlarge(distance(to, other) / Math.max(1, distance(from, other)), between(to, other));
      camera.pan((to[0] - from[0]) / 2, (to[1] - from[1]) / 2);
    } else {
      camera.pan(to[0] - from[0], to[1] - from[1]);
    }
    down.set(event.pointerId, to);
    redraw();
  });

  const up = (/** @type {PointerEvent} */ event) => {
    // A finger that is lifted points nowhere.
    if (event.pointerType === 'touch') hand.hover(null);
    if (!down.delete(event.pointerId) || down.size > 0) return;
    if (mode === 'tool') hand.end();
    mode = 'none';
  };
  frame.addEventListener('pointerup', up);
  frame.addEventListener('pointercancel', up);
  frame.addEventListener('pointerleave', (/** @type {PointerEvent} */ event) => {
    hand.hover(null);
    // What a finger has touched is read after it was lifted.
    if (event.pointerType !== 'touch') hand.leave();
  });
  frame.addEventListener('wheel', (/** @type {WheelEvent} */ event) => {
    event.preventDefault();
    camera.enlarge(1.0015 ** -event.deltaY, pixel(event));
    redraw();
  }, { passive: false });
}
