// How the page looks at the end of a run, against pictures in expected/. `UPDATE=1` writes them anew.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import pixelmatch from 'pixelmatch';
import { PNG } from 'pngjs';
import { ROOT } from './command.mjs';
import { SIZES } from './accessibility.mjs';
import { open, SMALL, sleep } from './page.mjs';

const EXPECTED = path.join(ROOT, 'tests/browser/expected');
/** Seen when pictures differ: what came. */
const SEEN = path.join(ROOT, 'target/browser-seen');
/**
 * Share of the pixels that may differ. Edges of letters, which each version of the font library draws otherwise, are 2 to 5 % of the
 * pictures, and half of them may differ by more than the eye sees. A panel that is lost is more: the smallest, the kymograph, is 2.3 %.
 */
const SHARE = 0.02;
/** How often the page is looked at before it is judged. */
const LOOKS = 8;
/** The least difference of a colour that counts, of 1: that of `pixelmatch`, below which an eye sees none. */
const THRESHOLD = 0.1;

for (const [name, colorScheme] of [['phone', 'light'], ['notebook', 'light'], ['projector', 'light'], ['notebook', 'dark']]) {
  test(`the page looks as before: ${name}, ${colorScheme}`, async (t) => {
    const lab = await open(t, { toml: SMALL, viewport: SIZES[name], colorScheme });
    await lab.find('#field').selectOption('first_slip');
    await lab.runToEnd();
    await lab.page.mouse.move(0, 0);
    await lab.page.evaluate(() => document.activeElement.blur());
    const file = `${name}-${colorScheme}.png`;
    // The slowest panel is drawn twice a second. Steps per second are those of the machine.
    const look = async () => {
      await sleep(1200);
      return lab.page.screenshot({ mask: [lab.find('#numbers dd').last()], animations: 'disabled' });
    };
    if (process.env.UPDATE) {
      mkdirSync(EXPECTED, { recursive: true });
      writeFileSync(path.join(EXPECTED, file), await look());
      return;
    }
    assert.ok(existsSync(path.join(EXPECTED, file)), `expected/${file} is missing: UPDATE=1 writes it`);
    const expected = PNG.sync.read(readFileSync(path.join(EXPECTED, file)));
    const { width, height } = expected;
    let [png, share] = [null, 1];
    // A busy machine draws later.
    for (let looks = 0; looks < LOOKS && share > SHARE; looks++) {
      png = await look();
      const seen = PNG.sync.read(png);
      assert.deepEqual([seen.width, seen.height], [width, height]);
      share = pixelmatch(seen.data, expected.data, null, width, height, { threshold: THRESHOLD }) / (width * height);
    }
    t.diagnostic(`${(100 * share).toFixed(3)} % of the pixels differ`);
    if (share > SHARE) {
      mkdirSync(SEEN, { recursive: true });
      writeFileSync(path.join(SEEN, file), png);
    }
    assert.ok(share <= SHARE, `${(100 * share).toFixed(2)} % of the pixels differ from expected/${file}, where ${100 * SHARE} % may: compare with target/browser-seen/${file}`);
  });
}
