// SPDX-License-Identifier: Apache-2.0
// Maps finished by the real program, step by step on the page.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {Archive} from './support/archive.mjs';
import {launch, picture, violations, visit} from './support/browser.mjs';
import {until} from './support/rig.mjs';

const weave = `
fabric = "weave"
seed = 5
[camera]
width = 600
height = 400
mm_per_pixel = 0.05
[geometry]
kind = "plain"
[effects]
near_light = true
relief = true
`;
const making_ms = 60_000;

let browser, archive, solve;
before(async () => {
  archive = new Archive();
  await archive.add('weave', weave, 'fast');
  await archive.serve();
  solve = archive.solve('weave', 'fast');
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await archive?.stop();
});

async function openFinish(visitor, of = `weave/${solve}`) {
  const page = await visitor.open(`${archive.address}/viewer/${of}?panel=finish`);
  await page.getByRole('heading', {name: 'Finish'}).waitFor();
  await page.getByRole('button', {name: 'Recipe tile'}).waitFor();
  return page;
}

const steps = (page) => page.locator('.finish .step strong').allInnerTexts();
const newestJob = async () => (await archive.ask('jobs?limit=1')).jobs[0];

async function add(page, step) {
  await page.getByLabel('Step to add').selectOption(step);
  await page.getByRole('button', {name: 'Add', exact: true}).click();
}

async function type(page, label, text) {
  const field = page.getByLabel(label, {exact: true});
  await field.fill(text);
  await field.press('Enter');
}

/** The keys of the page, not those of a field. */
async function press(page, key, times) {
  await page.locator('.finish h2').click();
  for (let i = 0; i < times; ++i) await page.keyboard.press(key);
}

test('twenty edits are undone, and done again after the daemon and the page began anew', async () => {
  const visitor = await visit(browser, archive);
  let page = await openFinish(visitor);
  await add(page, 'crop');
  for (let i = 1; i <= 17; ++i) await type(page, '1 crop left_mm', String(i / 10));
  await add(page, 'tile');
  await type(page, '2 tile repeats', '2 2');
  assert.deepEqual(await steps(page), ['1 crop', '2 tile']);
  await press(page, 'Control+z', 20);
  assert.deepEqual(await steps(page), []);
  assert.ok(await page.getByRole('button', {name: 'Undo'}).isDisabled());

  await page.close();
  await archive.restart();
  page = await openFinish(visitor);
  assert.deepEqual(await steps(page), []);
  await press(page, 'Control+y', 20);
  assert.deepEqual(await steps(page), ['1 crop', '2 tile']);
  assert.equal(await page.getByLabel('1 crop left_mm', {exact: true}).inputValue(), '1.7');
  assert.equal(await page.getByLabel('2 tile repeats', {exact: true}).inputValue(), '2 2');
  await visitor.leave();
});

test('a recipe is seen as a preview, and all maps are made of it', async () => {
  const visitor = await visit(browser, archive);
  const page = await openFinish(visitor);
  await page.getByRole('button', {name: 'Recipe flat'}).click();
  assert.deepEqual(await steps(page), ['1 flatten']);
  await page.getByRole('img', {name: 'Preview, relit'}).waitFor({timeout: making_ms});
  await page.waitForFunction(() => document.querySelector('.preview img').naturalWidth > 0);
  const preview = await newestJob();
  assert.deepEqual([preview.kind, preview.wants.preview, preview.of], ['finish', true, 'weave']);
  assert.equal(preview.result.preview, true);

  assert.ok(await page.getByRole('button', {name: '1 flatten later'}).isDisabled());
  await add(page, 'color');
  await page.getByRole('button', {name: '2 color earlier'}).click();
  assert.deepEqual(await steps(page), ['1 color', '2 flatten']);
  await until(async () => {
    const {state, result} = await newestJob();
    return state === 'done' && result.steps.map((step) => step.do).join() === 'color,flatten';
  });
  const {sets} = await archive.ask('sessions/weave/maps');
  assert.equal(sets.filter((set) => set.preview).length, 1, 'earlier previews go');
  assert.deepEqual(await violations(page), []);
  await picture(page, 'finish');

  await page.getByRole('button', {name: 'Remove 1 color'}).click();
  await page.getByRole('button', {name: 'Finish: make all maps'}).click();
  await page.getByRole('button', {name: 'Look at the last ones'}).click({timeout: making_ms});
  await page.waitForURL(/viewer\/weave\/maps\/[0-9a-f]+\?.*panel=why/);
  await page.locator('canvas[data-ready=true]').waitFor();
  await page.getByRole('table', {name: 'Maps'}).getByRole('row', {name: /^height/}).getByText('derived').waitFor();
  await page.keyboard.press('7');
  await page.waitForURL(/layer=height/);
  await page.locator('canvas[data-ready=true]').waitFor();
  await page.getByText('Height, mm').waitFor();
  assert.equal(await page.getByRole('tab', {name: 'Compare'}).count(), 0);
  assert.deepEqual(await violations(page), []);
  await picture(page, 'maps');

  await page.getByRole('button', {name: '2 × 2'}).click();
  await page.waitForURL(/repeat=2/);
  await page.locator('canvas[data-ready=true]').waitFor();
  await page.locator('.seam rect').nth(3).waitFor({state: 'attached'});
  assert.equal(await page.locator('.seam rect').count(), 4);
  await page.keyboard.press('t');
  await page.locator('.seam rect').nth(8).waitFor({state: 'attached'});
  await page.getByRole('button', {name: 'Seam'}).click();
  await page.locator('.seam').waitFor({state: 'detached'});
  await visitor.leave();
});

test('a tile is seen twice a side, with what is found of its seam', async () => {
  const visitor = await visit(browser, archive);
  const page = await openFinish(visitor);
  await page.getByRole('button', {name: 'Recipe tile'}).click();
  assert.deepEqual(await steps(page), ['1 flatten', '2 straighten', '3 tile']);
  await page.locator('.preview .twice img').nth(3).waitFor({timeout: making_ms});
  const {result} = await newestJob();
  assert.equal(result.is_tile, true);
  await page.locator('.finish .facts').getByText(/seam x: /).waitFor();
  for (const {text} of result.verdicts) await page.locator('.finish .verdicts').getByText(text).waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, 'finish_tile');
  await page.getByRole('link', {name: 'Look at the preview'}).click();
  await page.waitForURL(/viewer\/weave\/maps\/[0-9a-f]+\?.*repeat=2/);
  await page.locator('canvas[data-ready=true]').waitFor();
  await page.locator('.seam rect').nth(3).waitFor({state: 'attached'});
  assert.equal(await page.locator('.seam rect').count(), 4);
  await visitor.leave();
});

test('what a step cannot be is said with its number', async () => {
  const visitor = await visit(browser, archive);
  visitor.mayFail(/status of 400/);
  const page = await openFinish(visitor);
  await page.getByRole('button', {name: 'Recipe flat'}).click();
  await type(page, '1 flatten degree', '9');
  await page.getByRole('alert').filter({hasText: 'step 1: degree'}).waitFor();
  await page.getByRole('button', {name: 'Undo'}).click();
  await page.getByRole('alert').waitFor({state: 'detached'});
  await visitor.leave();
});

test('of a set of maps a rectangle is a place to crop to', async () => {
  const {sets} = await archive.ask('sessions/weave/maps');
  const {id, mm_per_pixel} = sets.find((set) => !set.preview);
  const visitor = await visit(browser, archive);
  const page = await openFinish(visitor, `weave/maps/${id}`);
  assert.deepEqual(await steps(page), ['1 flatten'], 'its own steps, in a browser that has none');
  await page.goto(`${page.url()}&box=10,20,100,50`);
  await add(page, 'crop');
  await page.getByRole('button', {name: 'To the rectangle'}).click();
  const width_mm = String(Number((100 * mm_per_pixel).toFixed(3)));
  await page.waitForFunction((typed) => document.querySelector('[aria-label="2 crop width_mm"]').value === typed, width_mm);
  await visitor.leave();
});
