// @ts-check
// How this page and the server prove to each other that they know the token, without telling it: once the
// server has ended, somebody else may answer on its port.
//
// The tab keeps a name and the key that the token gives for it, and not the token, which other tabs have
// their keys from: what answers on the port after a reload can read whatever a tab keeps.

/** @param {Uint8Array} bytes */
const hexadecimal = (bytes) => [...bytes].map((byte) => byte.toString(16).padStart(2, '0')).join('');

/** A random number of 32 hexadecimal digits. */
const draw = () => hexadecimal(crypto.getRandomValues(new Uint8Array(16)));

/** HMAC-SHA256 of a text, in hexadecimal digits. @param {string} key @param {string} text */
async function code(key, text) {
  const encoder = new TextEncoder();
  const usable = await crypto.subtle.importKey('raw', encoder.encode(key), { name: 'HMAC', hash: 'SHA-256' }, false, ['sign']);
  return hexadecimal(new Uint8Array(await crypto.subtle.sign('HMAC', usable, encoder.encode(text))));
}

/** Whether the address holds a token. */
export const hasToken = () => new URLSearchParams(location.hash.slice(1)).has('token');

/** Takes the token out of the address and out of what the browser remembers, and keeps the key of this tab; whether it was one. */
export async function takeToken() {
  const parts = new URLSearchParams(location.hash.slice(1));
  const token = parts.get('token') ?? '';
  parts.delete('token');
  const rest = parts.toString();
  history.replaceState(null, '', rest ? `#${rest}` : location.pathname);
  if (!/^[0-9a-f]{32}$/.test(token)) return false;
  const tab = draw();
  sessionStorage.setItem('key', await code(token, tab));
  sessionStorage.setItem('tab', tab);
  return true;
}

/** Forgets the key of a server that has ended. */
export const forget = () => sessionStorage.removeItem('key');

/** What is said for one connection, or null if this tab was never given a token. */
export async function proofs() {
  const [tab, key] = ['tab', 'key'].map((name) => sessionStorage.getItem(name));
  if (!tab || !key) return null;
  const nonce = draw();
  return { tab, nonce, server: await code(key, `server ${nonce}`), page: await code(key, `page ${nonce}`) };
}
