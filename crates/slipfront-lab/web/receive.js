// @ts-check
// What a session tells, on whichever way it comes: replies as JSON, pictures as bytes.
import { parse } from './frames.js';
import { put } from './store.js';

/** @import { Reply } from '../types/page' */

/** @param {string|ArrayBuffer} message */
export function receive(message) {
  if (typeof message === 'string') {
    /** @type {Reply} */
    const reply = JSON.parse(message);
    put(reply.is, reply);
  } else {
    const [topic, picture] = parse(message);
    put(topic, picture);
  }
}
