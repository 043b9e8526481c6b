// @ts-check
// A link that is opened in a tab without the token: another tab of this browser that is connected shows its
// case. Nothing is told there that the address does not hold, and no key is handed on.
import { state } from './store.js';

/** How long another tab may take to answer. */
const PATIENCE_MS = 1000;

/** What tabs say: who asks, who answers, and what the one that answers first shall show. @typedef {{ask: string, answer?: string, hash?: string}} Said */

const draw = () => crypto.randomUUID();

/** Lets another tab that is connected open the address of this tab; whether one does. @returns {Promise<boolean>} */
export function handOver() {
  if (location.hash.length < 2) return Promise.resolve(false);
  const channel = new BroadcastChannel('slipfront.lab');
  const ask = draw();
  return new Promise((resolve) => {
    setTimeout(() => {
      channel.close();
      resolve(false);
    }, PATIENCE_MS);
    channel.onmessage = ({ data }) => {
      const { ask: asked, answer } = /** @type {Said} */ (data);
      if (asked !== ask || !answer) return;
      channel.onmessage = null;
      channel.postMessage({ ask, answer, hash: location.hash });
      resolve(true);
    };
    channel.postMessage({ ask });
  });
}

/** Opens what tabs without the token hand over, as long as this one is connected. */
export function takeOver() {
  const own = draw();
  const channel = new BroadcastChannel('slipfront.lab');
  channel.onmessage = ({ data }) => {
    const { ask, answer, hash } = /** @type {Said} */ (data);
    if (!state.connected?.yes) return;
    if (!answer) channel.postMessage({ ask, answer: own });
    // A token is for the tab that was opened with it.
    else if (answer === own && hash && !new URLSearchParams(hash.slice(1)).has('token')) {
      history.replaceState(null, '', hash);
      window.dispatchEvent(new Event('hashchange'));
    }
  };
}
