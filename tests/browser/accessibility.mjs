// What axe-core finds, at the sizes of a phone, a notebook and a projector, light and dark, with each dialog
// open.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import test from 'node:test';
import { open, say, SMALL, until } from './page.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
export const SIZES = { phone: { width: 360, height: 740 }, notebook: { width: 1280, height: 800 }, projector: { width: 1920, height: 1080 } };
const DIALOGS = ['presets', 'lessons', 'keep', 'measure', 'help'];
/** A record of no slider. */
const RECORD = ['time (ns),force (N)', ...Array.from({ length: 60 }, (_, k) => `${k},${k}`)].join('\n');

for (const colorScheme of ['light', 'dark']) {
  for (const [name, viewport] of Object.entries(SIZES)) {
    test(`nothing stands in the way of a reader: ${name}, ${colorScheme}`, async (t) => {
      // Axe comes into the page as a script of the test.
      const lab = await open(t, { toml: SMALL, viewport, colorScheme, bypassCSP: true });
      await lab.page.evaluate(axe);
      const check = async (part, selector) => {
        const { violations } = await lab.page.evaluate((within) => window.axe.run(within, { resultTypes: ['violations'] }), selector);
        const found = violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => `${node.target} (${node.failureSummary})`).join('; ')}`);
        assert.deepEqual(found, [], part);
      };
      await lab.find('#shapes button').first().click();
      await check('page', 'html');
      for (const dialog of DIALOGS) {
        await lab.press(`open-${dialog}`);
        await check(dialog, `#${dialog}`);
        await lab.page.keyboard.press('Escape');
      }
      await lab.after(() => lab.find('#record-file').setInputFiles({ name: 'rig.csv', mimeType: 'text/csv', buffer: Buffer.from(RECORD) }), 'record');
      await lab.find('#control-load-slider').evaluate((slider) => {
        // A telephone folds the sliders at first.
        slider.closest('details').open = true;
        slider.focus();
      });
      await until(() => lab.last.sensitivity, 'what a slider does');
      await check('record', '#results');
      await check('sliders', '#controls');
      await lab.press('open-measure');
      await check('columns', '#measure');
      await lab.page.keyboard.press('Escape');
      await lab.press('open-calibrate');
      await check('calibrate', '#calibrate');
      await lab.page.keyboard.press('Escape');
      await lab.page.evaluate(async () => {
        const { put } = await import('./store.js');
        put('calibrating', { stage: 'training', runs: 10, of: 360 });
      });
      await check('calibrating', '#calibrating-row');
      await lab.page.evaluate(async () => {
        const { put } = await import('./store.js');
        const unknowns = [{ key: 'friction.mu_static', unit: null, median: 0.5, interval: [0.4, 0.6], range: [0.3, 0.9], is_determined: true }];
        put('calibrated', { outcome: 'done', sentence: null, results: { unknowns, is_refused: true, report: 'a line\n'.repeat(60), toml: '', set: {} } });
      });
      await lab.press('show-calibrated');
      await check('calibrated', '#calibrated');
      await lab.page.keyboard.press('Escape');
      await lab.press('open-lessons');
      await lab.find('#lessons-list button').first().click();
      await until(() => lab.find('#lesson').isVisible(), 'a lesson');
      await check('lesson', '#lesson');
      // Nothing is wider than the window.
      assert.ok(await lab.page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'the page is wider than the window');
    });
  }
}

test('who asks for little motion finds the run paused, and reads why', async (t) => {
  const lab = await open(t, { toml: SMALL, keepNotices: true });
  await lab.notice(say('starts_paused'));
  await lab.reads('pause', say('play'));
  assert.equal(lab.sent.find((order) => order.do === 'view').paused, true);
  assert.equal(lab.last.picture.step, 0);
});
