// SPDX-License-Identifier: Apache-2.0
// Maps of real solves, looked at in a real browser.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import {after, before, test} from 'node:test';
import {PNG} from 'pngjs';
import {Archive} from './support/archive.mjs';
import {launch, luminanceOf, picture, pixelsOf, violations, violationsByWidth, visit} from './support/browser.mjs';

const map = {width: 1400, height: 900};
const twill = `
fabric = "twill"
seed = 3
[camera]
width = ${map.width}
height = ${map.height}
mm_per_pixel = 0.05
[geometry]
kind = "twill"
warp_pitch_mm = 0.9
weft_pitch_mm = 0.9
[material]
warp_albedo = [0.34, 0.045, 0.03]
weft_albedo = [0.62, 0.52, 0.36]
stripe_yarns = 4
[effects]
near_light = true
relief = true
noise = true
`;
const card = `
fabric = "grey card"
[camera]
width = 200
height = 150
[geometry]
kind = "flat"
[material]
albedo = 0.2
[effects]
near_light = true
`;

let browser, archive, standard, fast;
before(async () => {
  archive = new Archive();
  await archive.add('twill', twill, 'fast', 'standard');
  await archive.add('card', card, 'standard');
  await archive.serve();
  [standard, fast] = ['standard', 'fast'].map((level) => archive.solve('twill', level));
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await archive?.stop();
});

/** The picture with everything that it needs. */
async function ready(page) {
  await page.locator('canvas[data-ready=true]').waitFor();
}

async function look(visitor, words, name = `twill/${standard}`) {
  const page = await visitor.open(`${archive.address}/viewer/${name}${words ? `?${new URLSearchParams(words)}` : ''}`);
  await ready(page);
  return page;
}

/** A part of the window. */
function part({data, width}, box) {
  const rows = [];
  for (let y = box.y; y < box.y + box.height; y++) rows.push(data.subarray((y * width + box.x) * 4, (y * width + box.x + box.width) * 4));
  return {width: box.width, height: box.height, data: Buffer.concat(rows)};
}

/** What the canvas shows, without what lies on it at its edges. */
async function seen(page) {
  await page.locator('.minimap img').evaluateAll((pictures) => Promise.all(pictures.map((each) => each.decode())));
  const box = await page.locator('canvas').boundingBox();
  return {...part(await pixelsOf(page), box), box};
}

/** The part of the canvas that a box of the map has under a view. */
function under(shown, view, box) {
  const x = Math.round(shown.width / 2 - view.x * view.zoom) + Math.round(box.x * view.zoom);
  const y = Math.round(shown.height / 2 - view.y * view.zoom) + Math.round(box.y * view.zoom);
  return part(shown, {x, y, width: Math.round(box.width * view.zoom), height: Math.round(box.height * view.zoom)});
}

function shareChanged(a, b) {
  let changed = 0;
  for (let at = 0; at < a.data.length; at += 4) {
    changed += [0, 1, 2].some((channel) => Math.abs(a.data[at + channel] - b.data[at + channel]) > 3);
  }
  return changed / (a.data.length / 4);
}

function colours(shown) {
  const found = new Set();
  for (let at = 0; at < shown.data.length; at += 4) found.add(shown.data.readUIntBE(at, 3));
  return found;
}

const inMiddle = '700,450,1';

test('every layer that the maps have is shown by its key', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor);
  await page.locator('canvas').focus();
  let before = await seen(page);
  for (const [key, layer] of [['1', 'Albedo'], ['2', 'Normals'], ['4', 'Sigma'], ['5', 'Residual'], ['6', 'Status'], ['3', 'Relit']]) {
    await page.keyboard.press(key);
    await page.getByRole('button', {name: layer, pressed: true}).waitFor();
    await ready(page);
    const now = await seen(page);
    assert.ok(shareChanged(before, now) > 0.2, `${layer} looks as the layer before`);
    before = now;
  }
  await visitor.leave();
});

test('a light that is dragged turns the picture and asks for no tile', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor);
  const {box, ...before} = await seen(page);
  const tiles = [];
  page.on('request', (request) => request.url().includes('/tiles/') && tiles.push(request.url()));
  await page.keyboard.press('l');
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 150, y + 120, {steps: 8});
  await page.mouse.up();
  await page.keyboard.press('l');
  await page.getByRole('status').filter({hasText: 'from the lower right'}).waitFor();
  await page.waitForURL(/light=/);
  await ready(page);
  const changed = shareChanged(before, await seen(page));
  assert.ok(changed > 0.2, `${changed} of the pixels changed`);
  assert.deepEqual(tiles, []);
  await visitor.leave();
});

test('the light comes from the place of an LED, by its number', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor);
  const {leds, cloth_height_mm} = await archive.ask(`sessions/twill/solves/${standard}`);
  await page.getByRole('button', {name: 'LED 7', exact: true}).click();
  await page.waitForURL(/light=/);
  const light = new URL(page.url()).searchParams.get('light').split(',').map(Number);
  const {position_mm: [x, y, z]} = leds.find(({led}) => led === 7);
  const length = Math.hypot(x, y, z - cloth_height_mm);
  [x, y, z - cloth_height_mm].forEach((value, i) => assert.ok(Math.abs(value / length - light[i]) < 1e-4, `${light}`));
  await visitor.leave();
});

test('the table of a pixel says what the daemon says, reading by reading', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor, {view: '700,450,4'});
  const canvas = await page.locator('canvas').boundingBox();
  await page.mouse.click(canvas.x + 100, canvas.y + 100);
  await page.locator('.readings tbody tr').first().waitFor();
  const [x, y] = (await page.getByTestId('pixel-place').textContent()).split(',').map(Number);
  assert.equal(x, Math.floor((100 - Math.round(canvas.width / 2 - 2800)) / 4));
  assert.equal(y, Math.floor((100 - Math.round(canvas.height / 2 - 1800)) / 4));
  const said = await archive.ask(`sessions/twill/solves/${standard}/pixel?x=${x}&y=${y}`);
  const row = (name) => page.locator('.values tr', {has: page.getByRole('rowheader', {name, exact: true})}).locator('td').innerText();
  assert.equal(await row('Normals'), said.maps.normal.map((value) => value.toFixed(4)).join('  '));
  assert.equal(await row('Albedo'), said.maps.albedo.map((value) => value.toFixed(4)).join('  '));
  assert.equal(await row('Sigma'), `${said.maps.sigma[0].toFixed(2)}°`);
  const rows = await page.locator('.readings tbody tr').evaluateAll((all) => all.map((each) => [...each.children].map((cell) => cell.textContent)));
  assert.equal(rows.length, 10);
  said.readings.readings.forEach(({led, counts, reading, model, residual_sigma, used}, i) => {
    assert.deepEqual(rows[i].slice(0, 4), [String(led), String(counts), reading.toFixed(3), model.toFixed(3)]);
    if (used) assert.equal(rows[i].at(-1), residual_sigma.toFixed(1));
  });
  await visitor.leave();
});

test('while the pointer moves a pixel is asked about at most every 60 ms, and the answer names its own place', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor, {panel: 'pixel'});
  const canvas = await page.locator('canvas').boundingBox();
  const asked = [];
  page.on('request', (request) => request.url().includes('/pixel?') && asked.push(Date.now()));
  for (let i = 0; i < 60; i++) await page.mouse.move(canvas.x + 100 + 5 * i, canvas.y + 300);
  await page.locator('.readings tbody tr').first().waitFor();
  const began = asked[0];
  const most = 2 + (asked.at(-1) - began) / 60;
  assert.ok(asked.length <= most, `${asked.length} in ${asked.at(-1) - began} ms`);
  const view = map.width / canvas.width;
  const x = Math.floor((395 - Math.round(canvas.width / 2 - map.width / 2 / view)) * view);
  await page.getByTestId('pixel-place').filter({hasText: String(x)}).waitFor();
  await visitor.leave();
});

test('a flat card has normals of exactly (0, 0, 1), as a tile and on the screen', async () => {
  const visitor = await visit(browser, archive);
  const name = `card/${archive.solve('card', 'standard')}`;
  const page = await look(visitor, {layer: 'normal', view: '100,75,1'}, name);
  const tile = await page.evaluate(async (address) => [...new Set(new Uint32Array(await (await fetch(address)).arrayBuffer()))],
    `/api/v1/sessions/card/solves/${name.slice(5)}/tiles/normal/0/0_0.raw`);
  assert.deepEqual(tile, [(511 | (511 << 10) | (1022 << 20) | (3 << 30)) >>> 0]);
  const shown = under(await seen(page), {x: 100, y: 75, zoom: 1}, {x: 40, y: 30, width: 120, height: 90});
  assert.deepEqual([...colours(shown)].map((colour) => colour.toString(16)), ['8080ff']);
  await visitor.leave();
});

test('the relit cloth is as bright from afar as at 1:1', async () => {
  const visitor = await visit(browser, archive, {width: 1860, height: 1080});
  const light = '0.5,0.5,0.70710678';
  const bright = async (zoom) => {
    const view = {x: 700, y: 450, zoom};
    const page = await look(visitor, {view: `700,450,${zoom}`, light});
    const box = {x: 240, y: 200, width: 960, height: 480};
    return luminanceOf(under(await seen(page), view, box));
  };
  const near = await bright(1);
  for (const zoom of [0.5, 0.25]) {
    const far = await bright(zoom);
    assert.ok(Math.abs(far / near - 1) < 0.01, `${far} at ${zoom}, ${near} at 1:1`);
  }
  await visitor.leave();
});

test('a solve does not differ from itself, and does from another', async () => {
  const visitor = await visit(browser, archive);
  const view = {x: 700, y: 450, zoom: 1};
  const box = {x: 400, y: 300, width: 500, height: 200};
  const scale = {layer: 'difference', view: inMiddle, range: '0,0.1'};
  const itself = await look(visitor, {...scale, with: `twill/${standard}`});
  assert.equal(colours(under(await seen(itself), view, box)).size, 1);
  const other = await look(visitor, {...scale, with: `twill/${fast}`, panel: 'compare'});
  assert.ok(colours(under(await seen(other), view, box)).size > 50);
  const {normal} = await archive.ask(`compare?a=twill/${standard}&b=twill/${fast}`);
  await other.getByRole('row', {name: /Normals, mean/}).getByText(`${Number(normal.mean_deg.toPrecision(2))}`).waitFor();
  await other.keyboard.press('a');
  await other.getByRole('figure').getByText('Albedo difference, %').waitFor();
  await ready(other);
  assert.ok(colours(under(await seen(other), view, box)).size > 50);
  await itself.keyboard.press('a');
  await itself.waitForURL(/layer=albedo_difference/);
  await ready(itself);
  assert.equal(colours(under(await seen(itself), view, box)).size, 1);
  await visitor.leave();
});

test('left of the divider is this solve, right of it the other', async () => {
  const visitor = await visit(browser, archive);
  const words = {layer: 'sigma', view: inMiddle, range: '0,3'};
  const mine = await seen(await look(visitor, words));
  const others = await seen(await look(visitor, words, `twill/${fast}`));
  const page = await look(visitor, {...words, with: `twill/${fast}`});
  await page.keyboard.press('b');
  await page.waitForURL(/divider=0\.5/);
  await page.locator('.marks .divider').waitFor({state: 'attached'});
  assert.deepEqual(await page.locator('.side-names span').allTextContents(), [`standard ${standard.slice(0, 8)}`, `fast ${fast.slice(0, 8)}`]);
  await ready(page);
  const both = await seen(page);
  const half = Math.floor(both.width / 2);
  const left = {x: 0, y: 100, width: half - 3, height: 300};
  const right = {x: half + 3, y: 100, width: half - 6, height: 300};
  assert.equal(shareChanged(part(mine, left), part(both, left)), 0);
  assert.equal(shareChanged(part(others, right), part(both, right)), 0);
  assert.ok(shareChanged(part(mine, right), part(both, right)) > 0.01, 'the two solves look alike: the test is void');
  await page.mouse.move(both.box.x + both.width / 2, both.box.y + 300);
  await page.mouse.down();
  await page.mouse.move(both.box.x + both.width / 4, both.box.y + 310, {steps: 3});
  await page.mouse.up();
  await page.waitForURL(/divider=0\.25/);
  await visitor.leave();
});

test('its address shows the same in another tab, after a reload, and Back goes to the layer before', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor);
  const {box} = await seen(page);
  await page.mouse.move(box.x + 300, box.y + 200);
  await page.mouse.wheel(0, -300);
  await page.mouse.down();
  await page.mouse.move(box.x + 345, box.y + 267, {steps: 3});
  await page.mouse.up();
  await page.waitForURL(/view=/);
  await page.keyboard.press('2');
  await page.waitForURL(/layer=normal/);
  await page.mouse.move(5, 5);
  // The minimap's own picture is left to the browser: it shrinks it in more than one way.
  const all = async (tab) => {
    await ready(tab);
    await tab.evaluate(() => document.activeElement.blur());
    const shown = await seen(tab);
    return {...part(shown, {x: 0, y: 0, width: 720, height: shown.height}), place: await tab.locator('.minimap svg').innerHTML()};
  };
  const same = (a, b) => {
    assert.equal(shareChanged(a, b), 0);
    assert.equal(a.place, b.place);
  };
  const here = await all(page);
  const there = await visitor.open(page.url());
  same(here, await all(there));
  await page.reload();
  same(here, await all(page));
  await page.goBack();
  await page.getByRole('button', {name: 'Relit', pressed: true}).waitFor();
  await visitor.leave();
});

test('the ruler says the daemon\'s millimetres, and they are those of the scene', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor, {view: inMiddle});
  const {box} = await seen(page);
  await page.keyboard.press('r');
  await page.mouse.move(box.x + 100, box.y + 300);
  await page.mouse.down();
  await page.mouse.move(box.x + 500, box.y + 300, {steps: 4});
  await page.mouse.up();
  const said = await page.locator('p.measured').textContent();
  await page.waitForURL(/line=/);
  await page.locator('.axes').nth(1).waitFor();
  const [x0, y0, x1, y1] = new URL(page.url()).searchParams.get('line').split(',');
  const {mm} = await archive.ask(`sessions/twill/solves/${standard}/line?x0=${x0}&y0=${y0}&x1=${x1}&y1=${y1}`);
  assert.ok(Math.abs(mm - 400 * 0.05) < 0.02, `${mm} mm`);
  await page.locator('p.measured').filter({hasText: mm.toFixed(2)}).waitFor();
  assert.match(said, /mm/);
  await visitor.leave();
});

test('ruler and rectangle are laid by keys alone', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor, {view: inMiddle});
  await page.keyboard.press('r');
  await page.locator('canvas:focus').waitFor();
  assert.deepEqual(await violations(page), []);
  for (const key of ['ArrowUp', 'Enter', 'Shift+ArrowRight', 'Shift+ArrowRight', 'ArrowDown', 'ArrowLeft', 'Enter', 'ArrowDown']) await page.keyboard.press(key);
  await page.waitForURL(/line=700%2C449%2C739%2C450/);
  await page.locator('p.measured').waitFor();
  await page.getByRole('status').getByText('mark at 739, 451').waitFor();
  await page.keyboard.press('s');
  for (const key of ['Enter', 'Shift+ArrowDown', 'ArrowRight', 'Enter']) await page.keyboard.press(key);
  await page.waitForURL(/box=700%2C450%2C2%2C21/);
  await page.locator('.region').getByText('2 × 21 pixels').waitFor();
  await page.keyboard.press('s');
  await page.keyboard.press('ArrowRight');
  await page.waitForURL(({searchParams}) => Number(searchParams.get('view')?.split(',')[0]) > 750);
  await visitor.leave();
});

test('a rectangle has the figures that the daemon has', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor, {layer: 'albedo', view: inMiddle});
  const {box} = await seen(page);
  await page.keyboard.press('s');
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x + 320, box.y + 290, {steps: 4});
  await page.mouse.up();
  await page.waitForURL(/box=/);
  const [x, y, w, h] = new URL(page.url()).searchParams.get('box').split(',');
  assert.deepEqual([w, h], ['121', '91']);
  const {layers} = await archive.ask(`sessions/twill/solves/${standard}/region?x=${x}&y=${y}&w=${w}&h=${h}`);
  await page.locator('.region').getByText(`${w} × ${h} pixels`).waitFor();
  const green = page.locator('.region tbody tr', {has: page.getByRole('rowheader', {name: 'G', exact: true})});
  await green.getByText(layers.albedo.G.mean.toFixed(4)).first().waitFor();
  assert.equal(await page.locator('.histogram').count(), 3);
  await visitor.leave();
});

test('nine tiles repeat the map', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor, {view: '0,450,0.25'});
  await page.keyboard.press('t');
  await page.waitForURL(/repeat=3/);
  await ready(page);
  const shown = await seen(page);
  const box = {x: -600, y: 100, width: 500, height: 400};
  const view = {x: 0, y: 450, zoom: 0.25};
  assert.equal(shareChanged(under(shown, view, box), under(shown, view, {...box, x: box.x + map.width})), 0);
  await visitor.leave();
});

test('a snapshot is the picture over a line with its scale', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor, {layer: 'normal'});
  const shown = await seen(page);
  const waits = page.waitForEvent('download');
  await page.getByRole('button', {name: 'Snapshot'}).click();
  const download = await waits;
  assert.equal(download.suggestedFilename(), 'twill-normal.png');
  const file = PNG.sync.read(fs.readFileSync(await download.path()));
  assert.deepEqual([file.width, file.height], [shown.width, shown.height + 34]);
  const middle = {x: 300, y: 100, width: 200, height: 200};
  assert.equal(shareChanged(part(file, middle), part(shown, middle)), 0);
  await visitor.leave();
});

test('why: every stage with what it said, and the seconds', async () => {
  const visitor = await visit(browser, archive);
  const page = await look(visitor, {panel: 'why'});
  const {seconds} = await archive.ask(`sessions/twill/solves/${standard}/report`);
  await page.locator('.stages li', {hasText: 'Cast shadows'}).getByText('did not run').waitFor();
  await page.locator('.stages li', {hasText: 'Sharpening'}).waitFor();
  assert.equal(await page.locator('.why table').last().locator('tbody tr').count(), Object.keys(seconds).length);
  await visitor.leave();
});

test('without WebGL the daemon shades, and it looks alike', async () => {
  const words = {view: '700,450,0.5', light: '0.6,0,0.8'};
  const visitor = await visit(browser, archive);
  const drawn = await seen(await look(visitor, words));
  await visitor.leave();
  const plain = await launch('--disable-3d-apis');
  try {
    const other = await visit(plain, archive);
    const page = await look(other, words);
    await page.getByText('This browser has no WebGL 2').waitFor();
    const box = {x: 100, y: 300, width: 1200, height: 500};
    const [a, b] = [drawn, await seen(page)].map((shown) => under(shown, {x: 700, y: 450, zoom: 0.5}, box));
    const means = [a, b].map(luminanceOf);
    assert.ok(means[0] > 0.02, `mean ${means[0]}`);
    assert.ok(Math.abs(means[1] / means[0] - 1) < 0.01, `${means}`);
    await page.keyboard.press('4');
    await page.getByRole('button', {name: 'Sigma', pressed: true}).waitFor();
    await ready(page);
    assert.ok(colours(await seen(page)).size > 20);
    const differing = await look(other, {layer: 'albedo_difference', with: `twill/${fast}`, range: '0,1'});
    assert.ok(colours(await seen(differing)).size > 20);
    await other.leave();
  } finally {
    await plain.close();
  }
});

test('a context that was lost comes back with the same picture', async () => {
  const visitor = await visit(browser, archive);
  visitor.mayFail(/CONTEXT_LOST_WEBGL/);
  const page = await look(visitor, {layer: 'normal', view: inMiddle});
  const before = await seen(page);
  const loss = await page.evaluateHandle(() => document.querySelector('canvas').getContext('webgl2').getExtension('WEBGL_lose_context'));
  await loss.evaluate((extension) => extension.loseContext());
  await page.getByText('took the graphics away').waitFor();
  await loss.evaluate((extension) => extension.restoreContext());
  await page.getByText('took the graphics away').waitFor({state: 'detached'});
  await ready(page);
  assert.equal(shareChanged(before, await seen(page)), 0);
  await visitor.leave();
});

test('each panel passes axe, and the canvas says what it shows and its keys', async () => {
  const visitor = await visit(browser, archive);
  const compared = {with: `twill/${fast}`, pixel: '200,150', line: '100,100,200,150', box: '10,10,50,50'};
  const page = await look(visitor, {...compared, layer: 'status'});
  for (const panel of ['Look', 'Pixel', 'Measure', 'Compare', 'Why']) {
    await page.getByRole('tab', {name: panel}).click();
    await page.getByRole('tabpanel', {name: panel}).locator('section').first().waitFor();
    assert.deepEqual(await violationsByWidth(page, `viewer-${panel.toLowerCase()}`), [], panel);
  }
  await page.keyboard.press('3');
  await page.getByRole('application', {name: /Relit/}).waitFor();
  const label = await page.getByRole('application').getAttribute('aria-label');
  assert.match(label, /^Relit from the upper left, 45 degrees high, twill\. Keys: 1 to 8/);
  await picture(page, 'viewer');
  await visitor.leave();
});

test('under 900 px the panel is below the picture', async () => {
  const visitor = await visit(browser, archive, {width: 820, height: 1100});
  const page = await look(visitor);
  const [canvas, panel] = await Promise.all(['canvas', '.viewer aside'].map((each) => page.locator(each).boundingBox()));
  assert.ok(panel.y >= canvas.y + canvas.height);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing reaches beyond the window');
  await visitor.leave();
});

test('an address without a solve becomes that of the newest; brackets go to the sessions beside', async () => {
  const visitor = await visit(browser, archive);
  const page = await visitor.open(`${archive.address}/viewer/twill`);
  await page.waitForURL(new RegExp(`/viewer/twill/(${standard}|${fast})`));
  await ready(page);
  const {sessions} = await archive.ask('sessions');
  const key = sessions[0].name === 'twill' ? ']' : '[';
  await page.keyboard.press(key);
  await page.waitForURL(/\/viewer\/card\//);
  await ready(page);
  await visitor.leave();
});

test('a solve that is not there is told in the daemon\'s words', async () => {
  const visitor = await visit(browser, archive);
  visitor.mayFail(/status of 404/);
  const page = await visitor.open(`${archive.address}/viewer/twill/0000000000000000`);
  await page.getByRole('alert').getByText('there is no such solve').waitFor();
  await visitor.leave();
});
