// @ts-check
// Lets a page without a server open without a network too, once it was opened. A page that is one file needs
// nothing for that.
import { isAlone, isSingle } from './assets.js';

/** Keeps the files of the page, where the browser can: on https, or on this machine. */
export function keepOffline() {
  if (!isAlone || isSingle || !isSecureContext || !('serviceWorker' in navigator) || !location.protocol.startsWith('http')) return;
  // Without it the page needs its network, and works.
  navigator.serviceWorker.register('service_worker.js').catch((error) => console.info(error));
}
