// @ts-check
// The WebSocket to the server. It connects again by itself; what was shown is opened again by session.js.
import { notice } from './notices.js';
import { handOver, takeOver } from './other_tab.js';
import { forget, hasToken, proofs, takeToken } from './proof.js';
import { receive } from './receive.js';
import { put } from './store.js';
import { say } from './text.js';

const SHORTEST_WAIT_MS = 500;
const LONGEST_WAIT_MS = 5000;
/** How long whoever answers may take to prove that it is the server. */
const PATIENCE_MS = 10_000;
/** The code with which a server closes the connection that ends. */
const ENDED = 1001;

/** The connection with a server that has proved that it is the one. @type {WebSocket|null} */
let socket = null;

/** Whether the server that gave this tab its token answers. @param {{tab: string, nonce: string, server: string}} said */
async function isServer({ tab, nonce, server }) {
  try {
    const answer = await fetch(`/proof/${tab}/${nonce}`, { signal: AbortSignal.timeout(PATIENCE_MS) });
    return (await answer.text()) === server;
  } catch {
    return false;
  }
}

/** What became of a connection that was none. */
const NONE = { proved: false, ended: false, reason: '' };

/** A connection from its begin to its end. @returns {Promise<{proved: boolean, ended: boolean, reason: string}>} */
async function once() {
  const said = await proofs();
  if (!said || !(await isServer(said))) return NONE;
  const { tab, nonce, page, server } = said;
  const opened = new WebSocket(`ws://${location.host}/ws`, ['slipfront.lab.v2', `tab.${tab}`, `nonce.${nonce}`, `proof.${page}`]);
  opened.binaryType = 'arraybuffer';
  let proved = false;
  return new Promise((resolve) => {
    // Whoever is not the server may leave a connection as it is for ever.
    const giveUp = () => {
      if (proved) return;
      opened.close();
      resolve(NONE);
    };
    setTimeout(giveUp, PATIENCE_MS);
    opened.onmessage = (event) => {
      if (proved) return receive(event.data);
      if (opened.readyState !== WebSocket.OPEN) return;
      // Somebody else may have taken the port since it was asked.
      proved = event.data === JSON.stringify({ is: 'proof', proof: server });
      if (!proved) return giveUp();
      socket = opened;
      put('connected', { yes: true });
    };
    opened.onclose = ({ code, reason }) => {
      if (!proved) return resolve(NONE);
      socket = null;
      resolve({ proved, ended: code === ENDED, reason });
    };
  });
}

/** Connects, and again after every loss, after longer and longer waits, until the server says that it ends. */
export async function connect() {
  window.addEventListener('hashchange', () => hasToken() && location.reload());
  if (hasToken() && !(await takeToken())) put('problem', { key: 'broken_token' });
  takeOver();
  if (!(await proofs()) && (await handOver())) return notice(say('opened_elsewhere'), { serious: true });
  for (let waitMs = SHORTEST_WAIT_MS; ; waitMs = Math.min(2 * waitMs, LONGEST_WAIT_MS)) {
    const { proved, ended, reason } = await once();
    put('connected', { yes: false, ended, reason });
    if (ended) return forget();
    if (proved) waitMs = SHORTEST_WAIT_MS;
    await new Promise((resolve) => setTimeout(resolve, waitMs));
  }
}

/** Sends a message, if there is a connection. @param {string} message */
export function send(message) {
  if (socket?.readyState === WebSocket.OPEN) socket.send(message);
}
