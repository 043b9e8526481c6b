// @ts-check
// The tools of the field: probe and move, brush, eraser, new shapes. They work the same by pointer and by
// keyboard.
import { send } from './connection.js';
import { change, gradual, newGesture } from './edit.js';
import { atMost, find, make, onPress } from './element.js';
import { camera, pointers, redraw } from './field.js';
import { TEXTURED } from './frames.js';
import { box, create, enlarge, handles, inside, move, outline, sliderOf, turn } from './shapes.js';
import { on, presentCase, put, state } from './store.js';
import { say } from './text.js';
import { setView } from './view.js';

/** @import { Tool } from '../types/page' */
/** @import { ShapeOutlines, Texture } from '../types/protocol' */

/** @type {Tool[]} */
export const TOOLS = ['probe', 'brush', 'eraser', 'circle', 'ellipse', 'polygon', 'groove', 'array'];
const PAINT_SPACING_MS = 33;
const PROBE_SPACING_MS = 50;
/** How near to a handle a pointer grips it, in pixels: a finger is wide. */
const GRIP_PIXELS = 12;
/** A drag of less than this many pixels is a click. */
const CLICK_PIXELS = 4;
const FEWEST_CORNERS = 3;

const slider = () => sliderOf(presentCase());

const paints = () => state.tool === 'brush' || state.tool === 'eraser';
const radius = () => find('brush-size').valueAsNumber / 2;

/** What the fields below the tools say of a new shape. */
function options() {
  const value = (/** @type {`option-${'s'|'sharp'|'w'|'columns'|'rows'}`} */ id) => find(id).valueAsNumber;
  const polygon = state.tool === 'polygon';
  return {
    s: polygon ? value('option-s') : 1,
    w: polygon ? Math.min(Math.max(value('option-sharp'), -1), 1) / value('option-s') : value('option-w'),
    columns: value('option-columns'),
    rows: value('option-rows'),
    orientation: find('option-orientation').value,
  };
}

/** Replaces one texture. @param {Texture[]} texture @param {number} index @param {Texture} table */
const replaced = (texture, index, table) => texture.map((old, k) => (k === index ? table : old));

/** Whether a shape or paint covers the block at a point. @param {number[]} point */
export function isTextured(point) {
  const { picture } = state;
  const [x, y] = point.map(Math.floor);
  return shapeAt(point) !== null || picture?.bytes[y * picture.nx + x] === TEXTURED;
}

/** The shape below a point, the last one if there are several. @param {number[]} point */
function shapeAt(point) {
  const hit = (state.case?.shapes ?? []).filter((shape) => inside(shape.outlines, point));
  return hit.length > 0 ? hit[hit.length - 1] : null;
}

/** The selected shape with its outlines. */
const selectedShape = () => (state.case?.shapes ?? []).find((shape) => shape.index === state.selected);

/** Whether a pointer at one point means the other one. @param {number[]} point @param {number[]} other */
function isNear(point, other) {
  const [[x, y], [toX, toY]] = [camera.toPixels(point), camera.toPixels(other)];
  return Math.hypot(toX - x, toY - y) <= GRIP_PIXELS;
}

/** Whether the point grips a handle of the selected shape. @param {number[]} point */
function gripped(point) {
  const shape = selectedShape();
  if (!shape || shape.outlines.length === 0) return false;
  return handles(presentCase().texture[shape.index], shape.outlines[0]).some((handle) => isNear(point, handle));
}

/** A drag that changes the selected shape: `alter` makes the new table of the old one and the present point. @param {(table: Texture, point: number[]) => Texture} alter */
function drag(alter) {
  const selected = /** @type {number} */ (state.selected);
  const { texture } = presentCase();
  const steps = gradual();
  return {
    move: (/** @type {number[]} */ point) => steps.change({ texture: replaced(texture, selected, alter(texture[selected], point)) }),
    end: steps.end,
  };
}

/** @param {number[]} from */
function dragToMove(from) {
  return drag((table, point) => move(table, [point[0] - from[0], point[1] - from[1]], slider()));
}

/** @param {number[]} from */
function dragToSize(from) {
  const { index, outlines } = /** @type {ShapeOutlines} */ (selectedShape());
  const { shape, orientation } = presentCase().texture[index];
  const [left, bottom, right, top] = box(outlines[0]);
  const reach = ([x, y] = from) => {
    const [dx, dy] = [x - (left + right) / 2, y - (bottom + top) / 2];
    return shape === 'groove' ? Math.abs(orientation === 'along' ? dy : dx) : Math.hypot(dx, dy);
  };
  return drag((table, point) => enlarge(table, Math.max(0.05, reach(point) / Math.max(reach(), 1e-6))));
}

/** A stroke of the brush: points are gathered and sent together. @param {number[]} from */
function stroke(from) {
  const gesture = newGesture();
  const textured = state.tool === 'brush';
  let points = [from];
  const flush = () => {
    if (points.length === 0) return;
    send({ do: 'paint', points, radius: radius(), textured, gesture });
    points = [];
  };
  const soon = atMost(flush, PAINT_SPACING_MS);
  let last = from;
  soon();
  return {
    move: (/** @type {number[]} */ point) => {
      // The line goes on from the last point that was sent.
      if (points.length === 0) points.push(last);
      points.push(point);
      last = point;
      soon();
    },
    end: flush,
  };
}

/** Selects a new shape, to be moved and sized. @param {number} index */
function select(index) {
  put('selected', index);
  chooseTool('probe');
}

/** Gives up the corners of an outline that is not closed. */
export function dropCorners() {
  pointers.corners = [];
  showCorners();
}

/** Makes the corners that were clicked an outline. */
export function closeOutline() {
  if (pointers.corners.length < FEWEST_CORNERS) return;
  const { texture } = presentCase();
  change({ texture: [...texture, outline(pointers.corners, slider())] });
  dropCorners();
  select(texture.length);
}

/** Adds a corner to the outline; the first one closes it. @param {number[]} point */
function addCorner(point) {
  const { corners } = pointers;
  if (corners.length >= FEWEST_CORNERS && isNear(point, corners[0])) return closeOutline();
  pointers.corners = [...corners, point];
  showCorners();
}

function showCorners() {
  find('polygon-close').disabled = pointers.corners.length < FEWEST_CORNERS;
  redraw();
}

/** Adds a shape of ordinary size around a point, or a corner to an outline. @param {number[]} point */
function place(point) {
  if (state.tool === 'polygon') return addCorner(point);
  const { texture } = presentCase();
  change({ texture: [...texture, create(state.tool, options(), point, 0, slider())] });
  select(texture.length);
}

/** A new shape whose size is dragged: it is there from the first move on, so that its true form is seen. @param {number[]} from */
function placing(from) {
  const { texture } = presentCase();
  const [tool, chosen] = [state.tool, options()];
  const steps = gradual();
  let sized = false;
  return {
    move: (/** @type {number[]} */ point) => {
      const size = Math.hypot(point[0] - from[0], point[1] - from[1]);
      if (!sized && size * camera.scale < CLICK_PIXELS) return;
      sized = true;
      steps.change({ texture: [...texture, create(tool, chosen, from, size, slider())] });
    },
    end: () => {
      if (!sized) return place(from);
      steps.end();
      select(texture.length);
    },
    cancel: () => {
      if (!sized) return;
      steps.end();
      send({ do: 'undo' });
    },
  };
}

/** The block that is probed. @type {number[]|null} */
let probed = null;
const tellProbed = atMost(() => setView({ probe: probed }), PROBE_SPACING_MS);

/** @param {number[]} point */
function probeSoon(point) {
  const at = point.map(Math.floor);
  const { blocks } = state.case ?? { blocks: [0, 0] };
  if (at.some((value, axis) => value < 0 || value >= blocks[axis])) return;
  if (probed && at[0] === probed[0] && at[1] === probed[1]) return;
  probed = at;
  tellProbed();
}

/** @type {{move(point: number[]): void, end(): void, cancel?(): void}|null} */
let doing = null;

/** What the pointers do. @type {import('./pointer.js').Hand} */
export const hand = {
  begin(point) {
    if (!state.case) return false;
    if (paints()) doing = stroke(point);
    else if (gripped(point)) doing = dragToSize(point);
    else if (state.tool !== 'probe') doing = placing(point);
    else {
      const shape = shapeAt(point);
      put('selected', shape ? shape.index : null);
      probeSoon(point);
      doing = shape ? dragToMove(point) : null;
    }
    return doing !== null;
  },
  move: (point) => doing?.move(point),
  end: () => {
    doing?.end();
    doing = null;
  },
  cancel: () => {
    pointers.ring = null;
    doing?.cancel?.();
    doing = null;
  },
  hover(point) {
    if (point) probeSoon(point);
    if (!doing || paints()) pointers.ring = point && paints() ? { point, radius: radius() } : null;
    redraw();
  },
  leave() {
    // The cursor of the keyboard stays where it is.
    if (!probed || pointers.cursor) return;
    probed = null;
    tellProbed();
  },
};

/** What Enter does at the cursor of the keyboard. @param {number[]} point */
export function press(point) {
  if (!state.case) return;
  if (paints()) stroke(point).end();
  else if (state.tool !== 'probe') place(point);
  else {
    const shape = shapeAt(point);
    put('selected', shape ? shape.index : null);
  }
  probeSoon(point);
}

/** Shows what a block under the cursor has. @param {number[]} point */
export const probeAt = (point) => probeSoon(point);

/** Changes the selected shape, if there is one. @param {(table: Texture) => Texture} alter */
function alterSelected(alter) {
  const { selected } = state;
  if (selected === null || !state.case?.texture[selected]) return;
  change({ texture: replaced(state.case.texture, selected, alter(state.case.texture[selected])) });
}

/** @param {number} dx blocks @param {number} dy blocks */
export const moveSelected = (dx, dy) => alterSelected((table) => move(table, [dx, dy], slider()));
/** @param {number} factor */
export const sizeSelected = (factor) => alterSelected((table) => enlarge(table, factor));
/** @param {number} degrees */
export const turnSelected = (degrees) => alterSelected((table) => turn(table, degrees));

/** Takes the selected shape away. */
export function removeSelected() {
  const { selected } = state;
  if (selected === null || !state.case?.texture[selected]) return;
  change({ texture: state.case.texture.filter((_, k) => k !== selected) });
  put('selected', null);
}

/** @param {Tool} tool */
export function chooseTool(tool) {
  put('tool', tool);
}

function showTool() {
  const { tool } = state;
  for (const name of TOOLS) find(`tool-${name}`).setAttribute('aria-pressed', String(name === tool));
  for (const element of document.querySelectorAll('[data-tools]')) {
    /** @type {HTMLElement} */ (element).hidden = !(element.getAttribute('data-tools') ?? '').split(' ').includes(tool);
  }
  find('tool-hint').textContent = say(`hint_${tool}`);
  find('frame').classList.toggle('draws', tool !== 'probe');
  pointers.ring = null;
  dropCorners();
}

/** Makes the buttons of the tools. */
export function startTools() {
  const buttons = TOOLS.map((tool) => {
    const button = make('button', { id: `tool-${tool}`, type: 'button', textContent: say(`tool_${tool}`) });
    button.addEventListener('click', () => chooseTool(tool));
    return button;
  });
  find('tools').prepend(...buttons);
  onPress('polygon-close', closeOutline);
  on('tool', showTool);
  on('case', ({ why }) => why === 'open' && dropCorners());
  chooseTool('probe');
}
