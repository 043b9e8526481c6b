// @ts-check
// The texture as outlines for a laser or a drawing program, offered as a file.
import { send } from './connection.js';
import { download, find, onPress } from './element.js';
import { notice } from './notices.js';
import { on, state } from './store.js';
import { say } from './text.js';

/** @import { DrawingReply } from '../types/protocol' */

const TYPES = { dxf: 'image/vnd.dxf', svg: 'image/svg+xml' };

/** @param {DrawingReply} drawing */
function take({ format, text, notes }) {
  const name = `${state.case?.name ?? 'case'}.${format}`;
  download(new Blob([text], { type: TYPES[format] }), name);
  notice([say('drawing_saved', { name }), ...notes].join(' '), { topic: 'drawing' });
}

/** Prepares the buttons. */
export function startDrawing() {
  for (const format of /** @type {const} */ (['dxf', 'svg'])) {
    onPress(`drawing-${format}`, () => {
      find('keep').close();
      send({ do: 'drawing', format });
    });
  }
  on('drawing', take);
}
