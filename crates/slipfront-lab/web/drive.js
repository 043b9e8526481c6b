// @ts-check
// The arrow in the field that tells whither the drive pulls.
import { find } from './element.js';
import { on } from './store.js';

/** Begins to listen: a drive that turns the slider has no direction. */
export function startDrive() {
  on('case', ({ drive_degrees: degrees }) => {
    find('drive').hidden = degrees === null;
    // Angles go from x towards y, which points up on the page.
    const arrow = /** @type {SVGElement} */ (find('drive').firstElementChild);
    arrow.style.transform = `rotate(${-(degrees ?? 0)}deg)`;
  });
}
