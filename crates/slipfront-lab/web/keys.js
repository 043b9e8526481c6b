// @ts-check
// Shortcuts: of the page, and of the field when it has the focus.
import { send } from './connection.js';
import { find } from './element.js';
import { camera, pointers, redraw } from './field.js';
import { on, presentCase, put, state } from './store.js';
import { chooseTool, closeOutline, dropCorners, isTextured, moveSelected, press, probeAt, removeSelected, sizeSelected, TOOLS, turnSelected } from './tools.js';
import { setView } from './view.js';

const ARROWS = /** @type {Record<string, number[]>} */ ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] });
const FAR = 5;

/** Where the cursor begins: at the middle of the slider, or beside it at the next block that the tool changes. */
function start() {
  const { blocks } = presentCase();
  const [x, y] = blocks.map((count) => Math.floor(count / 2) + 0.5);
  const row = Array.from({ length: Math.ceil(blocks[0] - x) }, (_, k) => [x + k, y]);
  return row.find((point) => isTextured(point) === (state.tool === 'eraser')) ?? [x, y];
}

/** @param {number[]} by */
function moveCursor([dx, dy]) {
  const { blocks } = presentCase();
  const [x, y] = pointers.cursor ?? start();
  pointers.cursor = [Math.min(Math.max(x + dx, 0.5), blocks[0] - 0.5), Math.min(Math.max(y + dy, 0.5), blocks[1] - 0.5)];
  probeAt(pointers.cursor);
  redraw();
}

/** Keys of the field. @param {KeyboardEvent} event @returns {boolean} whether the key meant something */
function fieldKey(event) {
  const { key } = event;
  const arrow = ARROWS[key];
  if (arrow) {
    const by = arrow.map((value) => value * (event.shiftKey ? FAR : 1));
    if (event.ctrlKey || event.metaKey) moveSelected(by[0], by[1]);
    else moveCursor(by);
  } else if (key === 'Enter' || (key === ' ' && state.tool !== 'probe')) {
    if (!pointers.cursor) moveCursor([0, 0]);
    press(/** @type {number[]} */ (pointers.cursor));
  } else if (key === '+' || key === '=') camera.enlarge(1.5, pointers.cursor ? camera.toPixels(pointers.cursor) : undefined);
  else if (key === '-') camera.enlarge(1 / 1.5);
  else if (key === '0') camera.reset();
  else if (key === ']') sizeSelected(1.1);
  else if (key === '[') sizeSelected(1 / 1.1);
  else if (key === ',') turnSelected(5);
  else if (key === '.') turnSelected(-5);
  else if (key === 'Delete' || key === 'Backspace') removeSelected();
  else if (key === 'c') closeOutline();
  else if (key === 'Escape') {
    dropCorners();
    put('selected', null);
    pointers.cursor = null;
    setView({ probe: null });
  } else return false;
  redraw();
  return true;
}

/** Keys of the page. @param {KeyboardEvent} event @returns {boolean} whether the key meant something */
function pageKey(event) {
  const key = event.key.toLowerCase();
  if (event.ctrlKey || event.metaKey) {
    if (key === 'z' || key === 'y') send({ do: event.shiftKey || key === 'y' ? 'redo' : 'undo' });
    return key === 'z' || key === 'y';
  }
  if (event.altKey) return false;
  if (key === ' ') find('pause').click();
  else if (key === 'n') send({ do: 'step', count: 1 });
  else if (key === 'r') send({ do: 'rest' });
  else if (key === '?') find('help').showModal();
  else if (/^[1-8]$/.test(key)) chooseTool(TOOLS[Number(key) - 1]);
  else return false;
  return true;
}

/** Whether a key belongs to the element that has the focus. @param {KeyboardEvent} event */
function typing({ target, key }) {
  const element = /** @type {Element} */ (target);
  if (element.closest('dialog')) return true;
  if (element.matches('input[type=range], input[type=radio], input[type=checkbox]')) return key.startsWith('Arrow') || key === ' ';
  return element.matches('input, select, textarea') || (element.matches('button, summary, a') && key === ' ');
}

/** Begins to listen. */
export function startKeys() {
  find('frame').addEventListener('keydown', (/** @type {KeyboardEvent} */ event) => {
    if (event.target !== find('frame') || !state.case || !fieldKey(event)) return;
    event.preventDefault();
    event.stopPropagation();
  });
  document.addEventListener('keydown', (event) => {
    if (!typing(event) && pageKey(event)) event.preventDefault();
  });
  on('case', ({ blocks }) => {
    if (pointers.cursor?.some((value, axis) => value > blocks[axis])) pointers.cursor = null;
  });
}
