// A page that is not seen, and one without a server.
import assert from 'node:assert/strict';
import { createHash, createHmac } from 'node:crypto';
import { existsSync, readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import path from 'node:path';
import test from 'node:test';
import { pathToFileURL } from 'node:url';
import { startLaboratory, startOnDesktop } from './command.mjs';
import { onServer, open, say, sleep, SMALL, until, untilSame } from './page.mjs';

/** Another user's program on the port of a laboratory that has ended: it notes what it is asked, and shows a page of its own. `prove`
 * gives what it answers when it is asked for a proof. It takes connections, and says there what the server would. */
async function startStranger(address, prove = () => '0'.repeat(64)) {
  const [asked, heard] = [[], []];
  const note = ({ method, url, rawHeaders }) => {
    // A browser asks for a picture of every site.
    if (url === '/favicon.ico') return;
    asked.push(`${method} ${url}`);
    heard.push(url, ...rawHeaders);
  };
  const server = createServer((request, response) => {
    note(request);
    const [, what, , nonce] = request.url.split('/');
    if (what === 'proof') return response.end(prove(nonce));
    response.setHeader('content-type', 'text/html');
    response.end('<title>stranger</title>');
  });
  server.on('upgrade', (request, socket) => {
    note(request);
    socket.on('data', (bytes) => heard.push(bytes.toString('latin1')));
    const accept = createHash('sha1').update(`${request.headers['sec-websocket-key']}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`).digest('base64');
    socket.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${accept}\r\nSec-WebSocket-Protocol: slipfront.lab.v2\r\n\r\n`);
    const hello = JSON.stringify({ is: 'hello', presets: [], folders: [], controls: [] });
    socket.write(Buffer.concat([Buffer.from([0x81, hello.length]), Buffer.from(hello)]));
  });
  await new Promise((resolve) => server.listen(Number(new URL(address).port), '127.0.0.1', resolve));
  const stop = () => {
    server.closeAllConnections();
    server.close();
  };
  return { asked, get heard() { return heard.join('\n'); }, stop };
}

/** Lets the page be hidden or seen, as another tab of the browser above it does. */
const setHidden = (lab, hidden) => lab.page.evaluate((value) => {
  Object.defineProperty(document, 'hidden', { configurable: true, get: () => value });
  document.dispatchEvent(new Event('visibilitychange'));
}, hidden);

test('a page that is not seen gets nothing', onServer, async (t) => {
  const lab = await open(t, { calm: false });
  await until(() => lab.last.numbers?.step > 3, 'a run that goes on');
  await setHidden(lab, true);
  await untilSame(() => lab.count, 'no message any more');
  const { step } = lab.last.numbers;
  await setHidden(lab, false);
  // It has not stood still because it had ended.
  await until(() => lab.last.numbers.step > step, 'a run that goes on again');
});

test('the browser is led to the page by a file, which is gone then', onServer, async (t) => {
  const one = await startOnDesktop();
  t.after(one.stop);
  await until(() => existsSync(one.opened), 'a browser that is started');
  const file = readFileSync(one.opened, 'utf8');
  assert.equal(statSync(file).mode & 0o777, 0o600);
  const lab = await open(t, { address: pathToFileURL(file).href });
  assert.equal(lab.page.url(), new URL('/', one.address).href);
  assert.equal(existsSync(path.dirname(file)), false);
  // It left nothing in the history to go back to, which would show the token.
  assert.equal(await lab.page.evaluate(() => document.referrer), '');
  await lab.page.goBack();
  assert.equal(lab.page.url(), 'about:blank');
});

test('a page whose server was stopped says so, and asks nobody on its port any more', onServer, async (t) => {
  const one = await startLaboratory();
  const lab = await open(t, { toml: SMALL, address: one.address });
  await one.stop();
  await lab.notice(say('ended'));
  const stranger = await startStranger(one.address);
  t.after(stranger.stop);
  // Longer than the longest wait between two attempts.
  await sleep(7000);
  assert.deepEqual(stranger.asked, []);
  assert.equal(await lab.page.evaluate(() => sessionStorage.getItem('key')), null);
});

test('a page gives nothing to another user who takes the port of a server that was killed', onServer, async (t) => {
  const one = await startLaboratory();
  const lab = await open(t, { toml: SMALL, address: one.address });
  const token = new URL(one.address).hash.match(/token=(\w+)/)[1];
  lab.alone = true;
  await one.kill();
  await lab.notice(say('lost'));
  const stranger = await startStranger(one.address);
  t.after(stranger.stop);
  const sockets = lab.sockets;
  await until(() => stranger.asked.length >= 2, 'two attempts');
  // It is asked for a proof, each time for another, and gives none: no connection is begun.
  for (const line of stranger.asked) assert.match(line, /^GET \/proof\/[0-9a-f]{32}\/[0-9a-f]{32}$/);
  assert.equal(new Set(stranger.asked).size, stranger.asked.length);
  assert.equal(lab.sockets, sockets);
  assert.ok(!stranger.heard.includes(token));
  // What answers a reload is a page of the stranger, which reads what the tab keeps: not the token, and no
  // key of other tabs.
  await lab.page.reload();
  assert.equal(await lab.page.title(), 'stranger');
  const kept = await lab.page.evaluate(() => JSON.stringify([{ ...sessionStorage }, { ...localStorage }, location.href, history.state, document.cookie]));
  assert.ok(!kept.includes(token), kept);
});

test('a server that knows the nonce and not the token is no server', onServer, async (t) => {
  const one = await startLaboratory();
  const lab = await open(t, { toml: SMALL, address: one.address });
  const [tab, key] = await lab.page.evaluate(() => ['tab', 'key'].map((name) => sessionStorage.getItem(name)));
  const token = new URL(one.address).hash.match(/token=(\w+)/)[1];
  const code = (key, text) => createHmac('sha256', key).update(text).digest('hex');
  assert.equal(code(token, tab), key);
  lab.alone = true;
  await one.kill();
  await lab.notice(say('lost'));
  // It has the right answer to the first question from somewhere, and takes the connection; there it cannot
  // prove it again.
  const prove = (nonce) => code(key, `server ${nonce}`);
  const stranger = await startStranger(one.address, prove);
  t.after(stranger.stop);
  const sent = lab.sent.length;
  await until(() => stranger.asked.filter((line) => line === 'GET /ws').length >= 2, 'two connections');
  assert.equal(lab.sent.length, sent);
  assert.ok(!stranger.heard.includes(key));
});

test('the address that a new server prints opens the page again in the same tab', onServer, async (t) => {
  const one = await startLaboratory();
  const lab = await open(t, { toml: SMALL, address: one.address });
  await one.stop();
  await lab.notice(say('ended'));
  const other = await startLaboratory('--port', new URL(one.address).port);
  t.after(other.stop);
  delete lab.last.hello;
  // Only what follows # differs: the browser loads nothing anew by itself.
  await lab.page.evaluate((address) => { location.href = address; }, other.address);
  await until(() => lab.last.hello, 'a connection');
  await until(async () => !(await lab.text('notices')).includes(say('ended')), 'no notice of a lost connection');
  assert.doesNotMatch(lab.page.url(), /token/);
});

test('a page loaded anew connects again', onServer, async (t) => {
  const lab = await open(t, { toml: SMALL });
  const hellos = lab.count.hello;
  await lab.page.reload();
  await until(() => lab.count.hello > hellos, 'a connection');
});

test('a page that loses its connection connects again, and shows the case it had', onServer, async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.find('#control-speed').fill('0.05');
  const { toml } = await lab.after(() => lab.find('#control-speed').press('Enter'), 'case');
  // What the server does not understand ends the connection.
  lab.alone = true;
  await lab.page.evaluate(async () => (await import('/connection.js')).send({ do: 'nothing' }));
  const shown = await until(() => lab.count.hello === 2 && lab.last.case?.why === 'open' && lab.last.case, 'a new connection');
  assert.equal(shown.toml, toml);
});
