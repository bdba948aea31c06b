// SPDX-License-Identifier: Apache-2.0
// Maps finished by the real program, step by step on the page.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {Archive} from './support/archive.mjs';
import {launch, picture, violations, violationsByWidth, visit} from './support/browser.mjs';
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

const atSet = /viewer\/weave\/maps\/([0-9a-f]+)\?/;
const ready = (page) => page.locator('canvas[data-ready=true]').waitFor({timeout: making_ms});

test('a recipe is looked at as it is changed, beside the cloth before, and all maps that are made of it open', async () => {
  const visitor = await visit(browser, archive);
  const page = await openFinish(visitor);
  const {width, height} = await archive.ask(`sessions/weave/solves/${solve}`);
  await page.getByRole('button', {name: 'Recipe flat'}).click();
  assert.deepEqual(await steps(page), ['1 flatten']);
  await page.waitForURL(/viewer\/weave\/maps\/[0-9a-f]+\?.*divider=0.5/, {timeout: making_ms});
  await ready(page);
  const preview = await newestJob();
  assert.deepEqual([preview.kind, preview.wants.preview, preview.of], ['finish', true, 'weave']);
  assert.equal(preview.result.preview, true);
  assert.ok(Math.abs(preview.result.width - width) < 0.05 * width && Math.abs(preview.result.height - height) < 0.05 * height,
    `${preview.result.width} x ${preview.result.height} of ${width} x ${height}`);

  assert.ok(await page.getByRole('button', {name: '1 flatten later'}).isDisabled());
  await add(page, 'color');
  await page.getByRole('button', {name: '2 color earlier'}).click();
  assert.deepEqual(await steps(page), ['1 color', '2 flatten']);
  const exposure = page.getByLabel('1 color exposure', {exact: true});
  await exposure.fill('-');
  await until(async () => {
    const {state, result} = await newestJob();
    return state === 'done' && result.steps.map((step) => step.do).join() === 'color,flatten' && page.url().includes(result.id);
  });
  assert.equal(await exposure.inputValue(), '-', 'what is typed stays while the picture changes');
  await exposure.fill('0');
  await exposure.press('Enter');
  const {sets} = await archive.ask('sessions/weave/maps');
  assert.equal(sets.filter((set) => set.preview).length, 1, 'earlier previews go');
  await ready(page);
  assert.deepEqual(await violations(page), []);
  await picture(page, 'finish');

  await page.getByRole('button', {name: 'Remove 1 color'}).click();
  const before = page.url();
  await page.getByRole('button', {name: 'Finish: make all maps'}).click();
  await page.waitForURL(/viewer\/weave\/maps\/[0-9a-f]+\?.*panel=why/, {timeout: making_ms});
  assert.notEqual(page.url().match(atSet)[1], before.match(atSet)[1]);
  await ready(page);
  await page.getByRole('table', {name: 'Maps'}).getByRole('row', {name: /^height/}).getByText('derived').waitFor();
  await page.keyboard.press('7');
  await page.waitForURL(/layer=height/);
  await ready(page);
  await page.getByText('Height, mm').waitFor();
  assert.equal(await page.getByRole('tab', {name: 'Compare'}).count(), 0);
  assert.deepEqual(await violations(page), []);
  await picture(page, 'maps');

  await page.getByRole('button', {name: '2 × 2'}).click();
  await page.waitForURL(/repeat=2/);
  await ready(page);
  await page.locator('.seam rect').nth(3).waitFor({state: 'attached'});
  assert.equal(await page.locator('.seam rect').count(), 4);
  await page.keyboard.press('t');
  await page.locator('.seam rect').nth(8).waitFor({state: 'attached'});
  await page.getByRole('button', {name: 'Seam'}).click();
  await page.locator('.seam').waitFor({state: 'detached'});
  await visitor.leave();
});

test('coarser grids are priced where all maps are asked for, and a click takes one', async () => {
  const visitor = await visit(browser, archive);
  const page = await openFinish(visitor);
  await page.getByRole('button', {name: 'What each grid costs'}).click();
  const grids = page.getByRole('list', {name: 'Grids'}).getByRole('button');
  await grids.nth(2).waitFor({timeout: making_ms});
  assert.match(await grids.nth(2).innerText(), /^0\.05\d* mm a pixel, \d+ × \d+: the one to buy\s*0° lost, [0-9.]+ s$/);
  await grids.nth(1).press('Enter');
  assert.equal(await grids.nth(1).getAttribute('aria-pressed'), 'true');
  assert.deepEqual(await violations(page), []);
  await picture(page, 'finish_grids');
  await page.getByRole('button', {name: 'Finish: make all maps'}).click();
  await page.waitForURL(/viewer\/weave\/maps\/[0-9a-f]+\?.*panel=why/, {timeout: making_ms});
  const {kind, result} = await newestJob();
  assert.equal(kind, 'maps');
  assert.ok(Math.abs(result.mm_per_pixel - 0.1) < 0.005, `${result.mm_per_pixel} mm`);
  await visitor.leave();
});

test('a tile is seen twice a side, with its repeat in millimetres on the cloth that it was cut from', async () => {
  const visitor = await visit(browser, archive);
  const page = await openFinish(visitor);
  await page.getByRole('button', {name: 'Recipe tile'}).click();
  assert.deepEqual(await steps(page), ['1 flatten', '2 straighten', '3 tile']);
  await page.waitForURL(/viewer\/weave\/maps\/[0-9a-f]+\?.*repeat=2/, {timeout: making_ms});
  await ready(page);
  const {result} = await newestJob();
  assert.equal(result.is_tile, true);
  await page.locator('.finish .facts').getByText(/seam x: /).waitFor();
  for (const {text} of result.verdicts) await page.locator('.finish .verdicts').getByText(text).waitFor();
  await page.locator('.seam rect').nth(3).waitFor({state: 'attached'});
  assert.equal(await page.locator('.seam rect').count(), 4);

  const {repeat} = result.steps[1].facts;
  await page.locator('.marks text').getByText(`${repeat.across_mm.toFixed(2)} × ${repeat.up_mm.toFixed(2)} mm, ${repeat.angle_deg.toFixed(1)}°`).waitFor();
  assert.equal(await page.locator('.marks svg :is(polygon, path)').count(), 2);
  assert.deepEqual(await page.locator('.side-names span').allInnerTexts(), ['before', 'after']);
  assert.deepEqual(await violationsByWidth(page, 'finish'), []);

  const divider = page.getByLabel('Before, after');
  await divider.focus();
  await page.keyboard.press('End');
  await page.waitForURL(/divider=1/);
  await press(page, 'b', 1);
  await page.locator('.marks svg').waitFor({state: 'detached'});
  await press(page, 'b', 1);
  await page.locator('.marks svg').waitFor();

  await press(page, 'Control+z', 1);
  await page.waitForURL(new RegExp(`viewer/weave/${solve}`));
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
  const {id, mm_per_pixel} = sets.find((set) => !set.preview && set.mm_per_pixel < 0.08);  // not the priced grid
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

test('what kind of cloth it is is asked once, kept with the session and said by its maps', async () => {
  const visitor = await visit(browser, archive);
  const page = await openFinish(visitor);
  assert.equal(await page.getByLabel('What kind of cloth is it?').inputValue(), '');
  await page.getByLabel('What kind of cloth is it?').selectOption('velvet');
  await until(async () => (await archive.ask('sessions/weave')).said.kind === 'velvet');
  await page.reload();
  await until(async () => (await page.getByLabel('What kind of cloth is it?').inputValue()) === 'velvet');
  await page.getByRole('button', {name: 'Finish: make all maps'}).click();
  await page.getByRole('table', {name: 'Maps'}).getByRole('row', {name: /^roughness/}).getByText('by its kind, velvet').waitFor({timeout: making_ms});
  await visitor.leave();
});
