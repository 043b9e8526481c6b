// @ts-check
// The WebSocket to the server. It connects again by itself; what was shown is opened again by session.js.
import { parse } from './frames.js';
import { put } from './store.js';

const LONGEST_WAIT_MS = 5000;

/** @type {WebSocket|null} */
let socket = null;
let waitMs = 500;

/** What a token is made of: with anything else there is no WebSocket, only an error. */
const TOKEN = /^\w+$/;

/** The token of the address, which is then kept for this tab and taken out of what the browser remembers. */
function token() {
  const parts = new URLSearchParams(location.hash.slice(1));
  const given = parts.get('token');
  if (given) {
    if (TOKEN.test(given)) sessionStorage.setItem('token', given);
    else put('problem', { key: 'broken_token' });
    const link = parts.get('case');
    history.replaceState(null, '', link ? `#case=${link}` : location.pathname);
  }
  return sessionStorage.getItem('token') ?? '';
}

/** @param {MessageEvent} event */
function receive({ data }) {
  if (typeof data === 'string') {
    const message = JSON.parse(data);
    put(message.is, message);
  } else {
    put(...parse(data));
  }
}

/** Connects, and again after every loss, after longer and longer waits. */
export function connect() {
  socket = new WebSocket(`ws://${location.host}/ws`, ['slipfront.lab.v1', `token.${token()}`]);
  socket.binaryType = 'arraybuffer';
  socket.onopen = () => {
    waitMs = 500;
    put('connected', { yes: true, reason: '' });
  };
  socket.onmessage = receive;
  socket.onclose = ({ reason }) => {
    put('connected', { yes: false, reason });
    setTimeout(connect, waitMs);
    waitMs = Math.min(2 * waitMs, LONGEST_WAIT_MS);
  };
}

/** Sends an order, if there is a connection. @param {Record<string, any>} order */
export function send(order) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(order));
}
