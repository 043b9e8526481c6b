// What the page tells by itself: whither the drive pulls, what to try, that a run has ended and what it has
// found.
import assert from 'node:assert/strict';
import test from 'node:test';
import { SIZES } from './accessibility.mjs';
import { link } from './command.mjs';
import { open, PLAIN, say, SMALL, until, webJson } from './page.mjs';

test('an arrow tells whither the drive pulls, unless it turns the slider', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const arrow = lab.find('#drive svg');
  assert.equal(await arrow.evaluate((svg) => svg.style.transform), 'rotate(0deg)');
  await lab.find('#control-direction').fill('30');
  await lab.after(() => lab.find('#control-direction').press('Enter'), 'case', ({ drive_degrees: degrees }) => degrees === 30);
  await until(async () => (await arrow.evaluate((svg) => svg.style.transform)) === 'rotate(-30deg)', 'an arrow that points up to the right');
  const turned = await open(t, { toml: `${PLAIN}\n[drive]\nmotion = "rotation"\n` });
  assert.equal(turned.last.case.drive_degrees, null);
  assert.equal(await turned.find('#drive').isVisible(), false);
});

test('a case that is opened stops at its first slip, its peak and when the front has crossed, and says so', async (t) => {
  const lab = await open(t, { toml: SMALL, calm: false });
  const captions = ['first_slip', 'peak', 'crossed'].map((stage) => say(`caption_${stage}`));
  const seen = [];
  const pauses = () => lab.sent.filter((order) => order.paused === true).length;
  await until(async () => {
    const text = await lab.text('story-text');
    if (captions.includes(text) && text !== seen.at(-1)) seen.push(text);
    return lab.last.numbers?.ended;
  }, () => `the end of the run, after ${seen}`);
  // One may be over before the next is reached.
  assert.deepEqual(seen, captions.filter((caption) => seen.includes(caption)));
  assert.ok(seen.length >= 2 && pauses() >= 2 && pauses() <= 3, `${seen}; ${pauses()} pauses`);
  assert.equal(await lab.text('story-text'), say('story', { width: '20 \u00b5m', pull: say('story_right'), seen: say('seen_front') }));
  // A run that begins again is not stopped, and none is once that was asked for.
  const before = pauses();
  await lab.after(() => lab.press('rest'), 'numbers', ({ ended }) => !ended);
  await lab.runToEnd();
  assert.equal(pauses(), before);
  await lab.find('#pace').press('Home');
  for (let k = 0; k < 12; k += 1) await lab.find('#pace').press('ArrowRight');
  await lab.after(() => lab.page.evaluate((hash) => (location.hash = hash), `#case=${link(`${SMALL}# again\n`)}`), 'case', ({ why }) => why === 'open');
  await lab.find('#story-off').click();
  await lab.reads('pause', say('pause'));
  const stopped = pauses();
  await lab.after(() => lab.page.reload(), 'case');
  await until(() => lab.last.numbers?.crossed, 'a front that has crossed');
  assert.equal(pauses(), stopped);
});

test('who asks for little motion is not stopped, and what the colours say follows the field', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.find('#pace').press('Home');
  for (let k = 0; k < 18; k += 1) await lab.find('#pace').press('ArrowRight');
  await lab.press('pause');
  await until(() => lab.last.numbers?.crossed, 'a front that has crossed');
  assert.deepEqual(lab.sent.filter((order) => order.do === 'view' && order.paused === true).length, 1);
  await lab.find('#field').selectOption('traction');
  await until(async () => (await lab.text('story-text')).endsWith(`${say('seen_traction')}.`), 'what colours of the traction say');
});

test('on a telephone the field, the number and the curve are seen at once, and a lesson leaves them in sight', async (t) => {
  for (const viewport of [{ width: 390, height: 844 }, { width: 844, height: 390 }]) {
    const lab = await open(t, { toml: SMALL, viewport, hasTouch: true, isMobile: true });
    const isSeen = async (id) => {
      const box = await lab.find(`#${id}`).boundingBox();
      assert.ok(box.y >= 0 && box.y + box.height <= viewport.height && box.x >= 0 && box.x + box.width <= viewport.width, `${id} at ${JSON.stringify(box)} of ${JSON.stringify(viewport)}`);
      return box;
    };
    for (const id of ['canvas', 'headline', 'plot-mu']) await isSeen(id);
    assert.equal(await lab.find('#control-speed').isVisible(), false);
    await lab.press('open-lessons');
    await lab.find('#lessons-list button').first().click();
    await lab.find('#lesson').waitFor();
    const [field, curve, sheet] = [await isSeen('frame'), await isSeen('plot-mu'), await lab.find('#lesson').boundingBox()];
    for (const box of [field, curve]) assert.ok(box.y + box.height <= sheet.y || box.x + box.width <= sheet.x, `${JSON.stringify(box)} below ${JSON.stringify(sheet)}`);
  }
});

test('a run says what to try, and at its end what it has found and three ways on', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.reads('next-text', say('next_try_more'));
  assert.equal(await lab.find('#next-buttons').isVisible(), false);
  const { peak, change_percent: change } = await lab.runToEnd();
  await lab.reads('next-text', say('next_found_change', { mu: peak.mu_star.toFixed(3), change: `${change.toFixed(1).replace('-', '\u2212')} %` }));
  await lab.reads('pause', say('ended_button'));
  assert.ok(await lab.find('#pause').isDisabled());
  await lab.after(() => lab.press('next-repeat'), 'repeated');
  await lab.press('next-paint');
  assert.equal(await lab.find('#tool-brush').getAttribute('aria-pressed'), 'true');
  // Another run goes on again, slowly enough to be seen.
  await lab.find('#pace').press('Home');
  await lab.after(() => lab.press('rest'), 'case', ({ why }) => why === 'rest');
  await until(async () => (await lab.text('pause')) !== say('ended_button'), 'a run that can be stopped');
});

test('static friction over seeds that change nothing comes with a note', async (t) => {
  const of = async (kinetic) => {
    const lab = await open(t, { toml: SMALL.replace('sigma_static_star = 0.02', `sigma_static_star = 0\nsigma_kinetic_star = ${kinetic}`) });
    await lab.after(() => lab.press('repeat'), 'repeated', ({ finished }) => finished);
    return lab.text('repeated');
  };
  assert.match(await of(0), /Note: every seed gives the same run/);
  assert.match(await of(0.1), /Note: only the kinetic coefficients differ from seed to seed/);
});

test('a case opens at the pace that suits its onset, and full speed stays', async (t) => {
  const lab = await open(t, {});
  const go = (name) => lab.after(() => lab.page.evaluate((hash) => (location.hash = hash), `#preset=${name}`), 'case', (shown) => shown.name === name);
  const pace = () => lab.sent.filter((message) => message.pace !== undefined).at(-1).pace;
  // The onset is expected 10/3 s after the beginning, to the tenth of a decade that the slider has.
  for (const name of ['steel', 'fast', 'circle']) {
    const { onset_star: onset } = await go(name);
    await until(() => Math.abs(Math.log10((pace() * 10) / 3 / onset)) < 0.06, () => `a pace for ${name}, not ${pace()}`);
  }
  await lab.find('#pace').press('End');
  await go('steel');
  await lab.find('#pace').press('End');
  assert.equal(pace(), 0);
});

test('a number may have its unit, and what is none is said to be none', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.find('#control-load').fill('2 MPa');
  await lab.after(() => lab.find('#control-load').press('Enter'), 'case', ({ values }) => values.load.si === 2e6);
  const { toml } = lab.last.case;
  await lab.find('#control-load').fill('abc');
  await lab.find('#control-load').press('Enter');
  await lab.notice(say('not_a_number', { name: say('control_load'), text: 'abc', example: say('not_a_number_example', { unit: 'Pa' }) }));
  await until(async () => (await lab.find('#control-load').inputValue()) === '2000000', 'the value that holds');
  // A unit of something else is refused by the case.
  await lab.find('#control-load').fill('2 m/s');
  await lab.after(() => lab.find('#control-load').press('Enter'), 'refused');
  assert.equal(lab.last.case.toml, toml);
});

test('what a block has is told as long as the pointer is on the field', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const point = async () => lab.after(async () => lab.page.mouse.move(...(await lab.at([2.5, 17.5]))), 'probe');
  await point();
  await lab.find('#probe').waitFor();
  await lab.page.mouse.move(2, 2);
  await lab.find('#probe').waitFor({ state: 'hidden' });
  // The same block again.
  await point();
  await lab.find('#probe').waitFor();
});

test('the page prints without what can only be pressed', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.runToEnd();
  await lab.page.emulateMedia({ media: 'print' });
  for (const id of ['tools', 'open-keep', 'open-measure', 'controls', 'next', 'zoom']) assert.equal(await lab.find(`#${id}`).isVisible(), false, id);
  for (const id of ['case-name', 'canvas', 'headline', 'numbers', 'plot-mu', 'kymograph']) assert.equal(await lab.find(`#${id}`).isVisible(), true, id);
  const { toml, values } = lab.last.case;
  assert.equal(await lab.text('printed-case'), toml);
  assert.ok(await lab.find('#printed-case').isVisible());
  assert.equal(await lab.find('#printed-values dt').count(), Object.keys(values).length + 4);
  assert.ok((await lab.text('printed-values')).includes(`${say('control_sigma')}${values.sigma.star}`));
  const pages = (await lab.page.pdf({ format: 'A4' })).toString('latin1').match(/\/Type\s*\/Page\b/g).length;
  assert.equal(pages, 1);
});

test('a lesson prints as a handout, with all its steps and its answers', async (t) => {
  const lab = await open(t, {});
  const [{ id, steps }] = await webJson('lessons.json');
  const words = (await webJson('lessons.en.json'))[id];
  await lab.press('open-lessons');
  await lab.find('#lessons-list button').first().click();
  await until(() => lab.find('#lesson').isVisible(), 'the lesson');
  assert.equal(await lab.find('#handout').isVisible(), false);
  await lab.page.emulateMedia({ media: 'print' });
  const printed = await lab.find('#handout').innerText();
  for (const step of steps) assert.ok(printed.includes(words.steps[step.id].title), step.id);
  assert.ok(printed.includes(say('handout_answers')));
  for (const selector of ['header', 'main', 'button']) assert.equal(await lab.find(selector).first().isVisible(), false, selector);
  await lab.page.emulateMedia({ media: 'screen' });
  await lab.press('lesson-close');
  await lab.page.emulateMedia({ media: 'print' });
  assert.ok(await lab.find('#canvas').isVisible());
});

test('the far end of the spring moves while the slider waits, and the page says whether blocks slip', async (t) => {
  const lab = await open(t, { toml: SMALL });
  const place = async (id) => Number(/translate\((-?[\d.]+)/.exec(await lab.find(`#${id}`).getAttribute('transform'))[1]);
  const [end, ground] = [await place('pull-end'), await place('pull-ground')];
  const loads = say('pull_loads', { mu: '[\\d.\u2212]+' });
  await lab.reads('pull-state', new RegExp(loads));
  // 5 t* per s: the first block in contact slips after some 8 s.
  await lab.find('#pace').fill('10');
  await lab.press('pause');
  await until(async () => (await place('pull-end')) > end + 5, 'a spring that is longer');
  // Textured blocks, which nothing holds, slip from the start and are not meant.
  assert.match(await lab.text('pull-state'), new RegExp(loads));
  const { mu_star: mu, peak } = await lab.runToEnd();
  // The peak is the largest force of this run.
  await lab.reads('pull-state', say('pull_slips', { mu: mu.toFixed(3), most: peak.mu_star.toFixed(3) }));
  assert.notEqual(await place('pull-ground'), ground);
  await lab.find('#pace').press('Home');
  await lab.press('rest');
  await lab.reads('pull-state', new RegExp(loads));
});

test('what the page shows is explained: letters, numbers, the percentage', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.runToEnd();
  await until(() => lab.find('#curve-letters').isVisible(), 'what letters are');
  assert.equal(await lab.find('#curve-letters').getAttribute('title'), say('meaning_letters_is'));
  for (const hint of ['meaning_sliding_is', 'number_without_hint']) assert.ok((await lab.find(`#numbers [title="${say(hint)}"]`).count()) > 0, hint);
  await lab.find('#summary summary').click();
  assert.ok((await lab.find(`#summary-values [title="${say('meaning_front_is')}"]`).count()) > 0);
  await lab.press('open-help');
  for (const what of ['headline', 'percent', 'sliding', 'letters', 'front']) await lab.reads('meanings', new RegExp(say(`meaning_${what}_is`).replace(/[.*+?^${}()|[\]\\]/g, '\\$&')));
});

test('instants that come after the last points of a curve have their letters', async (t) => {
  const lab = await open(t, { toml: SMALL });
  assert.equal(await lab.find('#curve-letters').isVisible(), false);
  await lab.page.evaluate(async () => {
    const { put, state } = await import('./store.js');
    put('numbers', { ...state.numbers, instants: { A: 1 } });
  });
  await until(() => lab.find('#curve-letters').isVisible(), 'what letters are');
});

test('a notice lies on neither the colour bar nor a button, and goes by itself', async (t) => {
  const lab = await open(t, { toml: SMALL });
  await lab.page.evaluate(() => {
    const { setTimeout: real } = window;
    // Twenty seconds are over at once.
    window.setTimeout = (action, delay, ...rest) => real(action, delay >= 20_000 ? 3000 : delay, ...rest);
  });
  await lab.find('#control-r_star').fill('-1');
  await lab.after(() => lab.find('#control-r_star').press('Enter'), 'refused');
  const box = await lab.find('.notice').boundingBox();
  for (const id of ['bar', 'field-choice', 'tools', 'zoom', 'controls', 'numbers-panel']) {
    const other = await lab.find(`#${id}`).boundingBox();
    const apart = box.x + box.width <= other.x || other.x + other.width <= box.x || box.y + box.height <= other.y || other.y + other.height <= box.y;
    assert.ok(apart, `the notice lies on #${id}`);
  }
  await until(async () => (await lab.find('.notice').count()) === 0, 'no notice');
});

test('on a telephone the header has two rows, friction is on the first screen, and fingers have room', async (t) => {
  const lab = await open(t, { toml: SMALL, viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  const header = await lab.find('header').boundingBox();
  assert.ok(header.height <= 2 * 40 + 3 * 6, `the header is ${header.height} high`);
  const headline = await lab.find('#headline').boundingBox();
  assert.ok(headline.y + headline.height <= 844, `friction ends at ${headline.y + headline.height}`);
  await lab.find('#shapes button').first().click();
  const small = async () => lab.find('button:visible, select:visible, summary:visible, input:visible').evaluateAll((all) => all
    .map((element) => [element, (element.matches('[type=radio]') ? element.closest('label') : element).getBoundingClientRect()])
    .filter(([, { width, height }]) => width < 40 || height < 40)
    .map(([element, { width, height }]) => `${element.id || element.textContent} ${width} x ${height}`));
  assert.deepEqual(await small(), []);
  await lab.press('more');
  assert.ok(await lab.find('#pace').isVisible() && await lab.find('#theme').isVisible());
  assert.deepEqual(await small(), []);
  await lab.press('open-help');
  const widths = await lab.find('#help dd').evaluateAll((all) => all.map((element) => element.getBoundingClientRect().width));
  assert.ok(Math.min(...widths) > 200, `a column of the help is ${Math.min(...widths)} wide`);
  assert.deepEqual(await small(), []);
});

test('the header keeps its height under a long name, at the end of a run and while a clip is recorded', async (t) => {
  const lab = await open(t, {});
  const height = async () => (await lab.find('header').boundingBox()).height;
  const before = await height();
  const long = 'a run whose name is long enough to fill half of the row of the header alone';
  const rename = () => lab.page.evaluate((name) => (document.getElementById('case-name').textContent = name), long);
  await lab.press('open-keep');
  await lab.press('clip');
  await lab.find('#clip-running').waitFor();
  await rename();
  assert.equal(await height(), before);
  await lab.download(() => lab.press('clip-running'));
  await lab.runToEnd();
  await rename();
  assert.equal(await height(), before);
});

test('letters grow on the screen of a projector', async (t) => {
  const sizes = async (viewport) => {
    const lab = await open(t, { toml: SMALL, viewport });
    await lab.runToEnd();
    return lab.page.evaluate(() => {
      const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
      const found = [];
      while (texts.nextNode()) {
        const element = texts.currentNode.parentElement;
        if (texts.currentNode.textContent.trim() && element.checkVisibility()) found.push(parseFloat(getComputedStyle(element).fontSize));
      }
      return { least: Math.min(...found), scrolls: document.documentElement.scrollHeight > innerHeight };
    });
  };
  const [small, large] = [await sizes(SIZES.notebook), await sizes(SIZES.projector)];
  assert.ok(large.least >= 13 && large.least > 1.2 * small.least, `${large.least} where ${small.least} are small`);
  assert.ok(!small.scrolls && !large.scrolls);
});
