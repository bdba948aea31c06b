// SPDX-License-Identifier: Apache-2.0
// A report as a file on a disk: its data, drawn by the script that it carries.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {after, before, test} from 'node:test';
import {launch, picture, violations} from './support/browser.mjs';

const script = fs.readFileSync(new URL('../../../app/web/dist/report.js', import.meta.url), 'utf8');
const section = {title: '', paragraphs: [], figures: [], note: '', is_half: false};
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'weft-report-'));
let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser.close();
  fs.rmSync(folder, {recursive: true});
});

async function open(data, options = {}) {
  const file = path.join(folder, 'report.html');
  const said = JSON.stringify({title: 'Camera', meta: [], summary: 'All is well.', verdicts: [], sections: [], ...data});
  fs.writeFileSync(file, `<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Camera</title></head><body><main>
    <p>Said without scripts</p></main><script type="application/json" id="report">${said.replaceAll('<', '\\u003c')}</script>
    <script>${script}</script></body></html>`);
  const page = await (await browser.newContext(options)).newPage();
  await page.goto(`file://${file}`);
  return page;
}

test('a report says what is wrong and what to do, or its summary', async () => {
  const well = await open({});
  await well.getByRole('heading', {name: 'Camera'}).waitFor();
  assert.equal(await well.locator('.verdict').innerText(), 'All is well.');
  assert.equal(await well.getByText('Said without scripts').count(), 0);
  const ill = await open({meta: ['10 lights'], verdicts: [{text: 'LED 3 is <b>dead</b>.', remedy: 'Check its cable.'}]});
  assert.deepEqual(await ill.locator('main > *').allInnerTexts(), ['Camera', '10 lights', 'All is well.', 'LED 3 is <b>dead</b>.\n\nCheck its cable.']);
});

test('a table has its alarms in red, small letters and bars', async () => {
  const page = await open({sections: [
    {...section, title: 'Lights', note: 'From 9 pixels.', table: {header: ['light', 'gain'], rows: [['LED 1\nthe first', '99 %'], ['LED 2', '7 %']], alarms: [1], bars: []}},
    {...section, title: 'Bars', table: {header: [], rows: [['LED 1', '1 %'], ['LED 2', '2 %']], alarms: [], bars: [0.5, 1]}},
  ]});
  assert.deepEqual(await page.locator('section').first().locator('th, td, .note').allInnerTexts(),
    ['light', 'gain', 'LED 1\n\nthe first', 'the first', '99 %', 'LED 2', '7 %', 'From 9 pixels.']);
  const colours = await page.locator('section').first().locator('tbody td').evaluateAll((cells) => cells.map((cell) => getComputedStyle(cell).color));
  assert.deepEqual(colours, ['rgb(34, 33, 31)', 'rgb(179, 38, 30)']);
  const [half, whole] = await page.locator('.bar').evaluateAll((bars) => bars.map((bar) => bar.getBoundingClientRect().width));
  assert.ok(whole > 100 && Math.abs(half / whole - 0.5) < 0.01, `${half} of ${whole}`);
  assert.deepEqual(await violations(page), []);
});

test('a map is squares by their values, those that are none white, over a scale', async () => {
  const page = await open({sections: [{...section, figures: [{label: 'sigma', map: {columns: 2, values: [0, 4, null, 2], unit: '<deg>', least: 0, most: 4}}]}]});
  const squares = await page.locator('.map rect').evaluateAll((all) => all.slice(0, 4).map((rect) => [rect.getAttribute('x'), rect.getAttribute('y'), rect.getAttribute('fill')].join(' ')));
  const [least, most, none, middle] = squares;
  assert.match(least, /^0 0 rgb/);
  assert.match(most, /^10 0 rgb/);
  assert.equal(none, '0 10 #fff');
  assert.match(middle, /^10 10 rgb/);
  assert.equal(new Set(squares).size, 4);
  assert.deepEqual(await page.locator('.map text').allTextContents(), ['0', '4 <deg>']);
  assert.equal(await page.locator('figcaption').innerText(), 'sigma');
});

test('arrows begin where they are and are longer than they are', async () => {
  const page = await open({sections: [{...section, figures: [{label: '', arrows: {width: 1280, height: 960, all: [[640, 480, 2, -1]], magnification: 10}}]}]});
  assert.equal(await page.locator('.arrows g').getAttribute('transform'), 'translate(320 240)');
  assert.deepEqual([await page.locator('line').getAttribute('x2'), await page.locator('line').getAttribute('y2')], ['10', '-5']);
  await picture(page, 'report');
});

test('without scripts a report says most of it', async () => {
  const page = await open({}, {javaScriptEnabled: false});
  await page.getByText('Said without scripts').waitFor();
});
