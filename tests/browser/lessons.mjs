// All lessons: every step loads its case, says its text with the numbers that lesson_numbers.json holds, and
// every button does what it is for.
import assert from 'node:assert/strict';
import test from 'node:test';
import { open, say, until, webJson, webText } from './page.mjs';

const lessons = await webJson('lessons.json');
const words = await webJson('lessons.en.json');
const numbers = await webJson('lesson_numbers.json');

/** The text of a paragraph as it is read: numbers stay with their units, asterisks emphasise, and another sign stands for that of symbols. */
const told = (text) => text.replace(/\{(\w+)\}/g, (_, id) => numbers[id].says.replaceAll(' ', '\u00a0')).replaceAll('*', '').replaceAll('\u2217', '*');

/** Whether a case has a value of a key, of the few forms that buttons of lessons set. */
function has({ toml, texture }, key, value) {
  if (key === 'texture') return JSON.stringify(texture) === JSON.stringify(value);
  const name = key.split('.').at(-1);
  return toml.split('\n').some((line) => line.replaceAll('"', '') === `${name} = ${JSON.stringify(value)?.replaceAll('"', '').replaceAll(',', ', ')}`);
}

assert.equal(lessons.length, 9);

for (const [number, lesson] of lessons.entries()) {
  test(`lesson ${number + 1}: ${told(words[lesson.id].title)}`, async (t) => {
    const lab = await open(t, {});
    await lab.press('open-lessons');
    assert.equal(await lab.find('#lessons-list button').count(), lessons.length);
    await lab.find('#lessons-list button').nth(number).click();
    for (const [k, step] of lesson.steps.entries()) {
      const said = words[lesson.id].steps[step.id];
      await lab.reads('lesson-step', say('lesson_step', { step: k + 1, of: lesson.steps.length, title: told(said.title) }));
      // The comment at the head of a case is for the readers of its file.
      const toml = (await webText(step.case)).replace(/^(#.*\n)+\n/, '');
      await until(() => lab.last.case.toml === toml && lab.last.case.why === 'open', () => `${step.case}; the case is ${lab.last.case.toml}`);
      for (const [id, texts] of [['lesson-text', said.text], ['lesson-answer-text', said.answer]]) {
        assert.deepEqual(await lab.find(`#${id} p`).allTextContents(), texts.map(told));
      }
      await lab.find('#lesson-answer summary').click();
      assert.ok(await lab.find('#lesson-answer-text').isVisible());
      const buttons = lab.find('#lesson-buttons button');
      const own = step.record ? 1 : 0;
      assert.equal(await buttons.count(), own + step.set.length);
      if (step.record) {
        assert.equal(await buttons.first().textContent(), say('lesson_record'));
        await lab.after(() => buttons.first().click(), 'record', ({ curve }) => curve !== null);
        await until(() => lab.find('#curve-measured').isVisible(), 'the record');
      }
      for (const [at, { id, keys = {}, view = {} }] of step.set.entries()) {
        const place = own + at;
        assert.equal(await buttons.nth(place).textContent(), told(said.set[id]));
        const from = lab.sent.length;
        if (Object.keys(keys).length > 0) {
          // The case of a step may come a second time before that of its button.
          await lab.after(() => buttons.nth(place).click(), 'case', ({ why }) => why === 'change');
        } else {
          await buttons.nth(place).click();
        }
        for (const [key, value] of Object.entries(keys)) assert.ok(has(lab.last.case, key, value), `${id} sets ${key} to ${JSON.stringify(value)}, and the case is ${lab.last.case.toml}`);
        const seen = Object.assign({}, ...lab.sent.slice(from).filter((order) => order.do === 'view'));
        for (const [key, value] of Object.entries(view)) assert.equal(seen[key], value, `${id} shows ${key}`);
      }
      assert.doesNotMatch(await lab.text('lesson'), /[{}]/);
      await lab.press('lesson-next');
    }
    await until(async () => !(await lab.find('#lesson').isVisible()), 'the end of the lesson');
  });
}
