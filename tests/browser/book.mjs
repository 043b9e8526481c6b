// The book as a site, which docs/build.sh makes, opened from the disk: its pages on a telephone and without a
// network, its search, and its cases in the laboratory.
import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import path from 'node:path';
import test, { after } from 'node:test';
import { pathToFileURL } from 'node:url';

process.env.CHANNEL = 'worker';
const { ROOT } = await import('./command.mjs');
const { browser, endAll, open, until } = await import('./page.mjs');

after(endAll);

const BOOK = path.join(ROOT, 'target/book');
const address = (name) => pathToFileURL(path.join(BOOK, name)).href;
const isPage = (name) => name.endsWith('.html') && !/^(api\/|(lab|toc)\.html$)/.test(name);
const pages = readdirSync(BOOK, { recursive: true }).filter(isPage);

/** On the disk a page and the laboratory in it are of two origins, so that the laboratory is not given the focus. */
const mayFail = (text) => text.startsWith('Blocked autofocusing');

/** Opens a page of the site; what it asks for elsewhere, and its errors, fail the test. */
async function openPage(t, name, width = 1280) {
  const page = await browser.newPage({ viewport: { width, height: 800 } });
  const faults = [];
  page.on('pageerror', (error) => faults.push(error.message));
  page.on('console', (message) => message.type() === 'error' && !mayFail(message.text()) && faults.push(message.text()));
  page.on('request', (request) => /^(file|data|blob):/.test(request.url()) || faults.push(request.url()));
  t.after(async () => {
    await page.close();
    assert.deepEqual(faults, [], name);
  });
  await page.goto(address(name));
  return page;
}

test('every page fits a telephone', async (t) => {
  assert.ok(pages.length >= 25, pages.join(' '));
  for (const name of pages) {
    const page = await openPage(t, name, 390);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390, name);
    await page.close();
  }
});

test('a word is found', async (t) => {
  const page = await openPage(t, 'index.html');
  await page.locator('#mdbook-search-toggle').click();
  await page.locator('#mdbook-searchbar').pressSequentially('herringbone');
  await page.locator('#mdbook-searchresults a').first().waitFor();
});

test('every case of the pages opens in the laboratory', async (t) => {
  const links = [];
  for (const name of pages) {
    const page = await openPage(t, name);
    const title = await page.locator('main h1').first().textContent();
    const found = await page.locator('main a[href*="lab.html#"]').evaluateAll((all) => all.map((link) => new URL(link.href).hash));
    links.push(...found.map((hash) => ({ hash, title })));
    await page.close();
  }
  assert.ok(links.filter(({ hash }) => hash.startsWith('#case=')).length >= 30, JSON.stringify(links));
  assert.ok(links.filter(({ hash }) => hash.startsWith('#preset=')).length >= 60, JSON.stringify(links));
  const lab = await open(t, { address: `${address('lab.html')}#` });
  for (const [hash, title] of new Map(links.map((link) => [link.hash, link.title]))) {
    const wanted = hash.startsWith('#preset=') ? hash.slice('#preset='.length) : title;
    await lab.after(() => lab.page.evaluate((text) => (location.hash = text), hash), 'case', ({ name }) => name === wanted);
  }
  assert.equal(lab.last.refused, undefined);
});

test('a case opens within its page, and closes', async (t) => {
  const page = await openPage(t, 'docs/guide/getting-started.html');
  await page.getByRole('button', { name: 'Try it here' }).first().click();
  const name = page.frameLocator('.lab iframe').locator('#case-name');
  await until(async () => (await name.textContent()) === 'Getting started', 'the case in the page');
  await page.getByRole('button', { name: 'Close the laboratory' }).click();
  assert.equal(await page.locator('.lab iframe').count(), 0);
});
