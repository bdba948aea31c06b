// SPDX-License-Identifier: Apache-2.0
// A cloth as a material: its size on the screen, where each of its parameters comes from, and how it leaves.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import {after, before, test} from 'node:test';
import {PNG} from 'pngjs';
import {Archive} from './support/archive.mjs';
import {launch, luminanceOf, picture, pixelsOf, violations, violationsByWidth, visit} from './support/browser.mjs';

const scene = `
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
/** Small enough that all of its maps are made in seconds. */
const swatch = scene.replace('"weave"', '"swatch"').replace('600', '240').replace('400', '160');
const dusty = `
schema = "weft.material/1"
inherits = "library:cloth/wool"
notes = "wool that lay in an attic"
[surface]
roughness = 0.8
[[layer]]
name = "dust"
material = "library:dirt/dust"
alpha = 0.5
mask = 0.4
`;
/** All that it sends back is its highlight. */
const golden = `
schema = "weft.material/1"
[surface]
albedo = [0, 0, 0]
roughness = 0.9
specular = 6
specular_tint = [1, 0.6, 0.2]
sheen = [0, 0, 0]
`;
const making_ms = 60_000;

let browser, archive, set;
before(async () => {
  archive = new Archive();
  await archive.add('weave', scene, 'fast');
  await archive.make('maps', 'weave', '--maps', 'height,occlusion,roughness');
  await archive.add('swatch', swatch);
  await archive.add('sketch', swatch.replace('"swatch"', '"sketch"'), 'preview');
  archive.write('.local/share/weft/materials/dusty.toml', dusty);
  archive.write('.local/share/weft/materials/golden.toml', golden);
  await archive.serve();
  [set] = (await archive.ask('sessions/weave/maps')).sets;
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await archive?.stop();
});

const address = (query = '') => `${archive.address}/material/weave/maps/${set.id}${query}`;
const drawn = (page) => page.locator('canvas[data-ready=true]').waitFor();

async function openMaterial(visitor, query = '') {
  const page = await visitor.open(address(query));
  await drawn(page);
  return page;
}

/** The first and the last pixel of the cloth in a row or column of the canvas. */
function extent(shot, box, along) {
  const of = (x, y) => shot.data[4 * (y * shot.width + x) + 1] > 20;
  const middle = Math.floor(along === 'x' ? box.y + box.height / 2 : box.x + box.width / 2);
  const [from, to] = along === 'x' ? [box.x, box.x + box.width] : [box.y, box.y + box.height];
  const seen = [];
  for (let at = Math.ceil(from); at < to; at++) if (along === 'x' ? of(at, middle) : of(middle, at)) seen.push(at);
  return seen.at(-1) - seen[0] + 1;
}

test('a plane, a ball and the true size show the millimetres that their bars say', async () => {
  const visitor = await visit(browser, archive, {width: 1200, height: 760});
  const page = await openMaterial(visitor, '?shape=true&surroundings=1');
  const bar = () => page.locator('.scale-bar .length').evaluate((each) => ({mm: Number(each.dataset.mm), px: parseFloat(each.style.width)}));
  const cloth_mm = [set.width * set.mm_per_pixel, set.height * set.mm_per_pixel];
  const {mm, px} = await bar();
  assert.equal(mm, 10);
  assert.ok(Math.abs(px - (10 * 96) / 25.4) < 0.05, `a bar of 10 mm is ${px} px`);
  const box = await page.locator('.material canvas').boundingBox();
  const wide = extent(await pixelsOf(page), box, 'x');
  assert.ok(Math.abs(wide - cloth_mm[0] * px / 10) < 1.5, `${cloth_mm[0]} mm of cloth are ${wide} px`);

  await page.getByRole('button', {name: 'Hold a card to it'}).click();
  await page.getByLabel('Size of the outline').fill('5');
  await page.getByText('this screen was measured').waitFor();
  assert.equal((await bar()).px, 50);
  await page.getByRole('button', {name: 'Forget it'}).click();

  await page.getByRole('button', {name: 'Plane'}).click();
  await page.waitForURL(/shape=plane/);
  await drawn(page);
  const plane = await bar();
  const flat = await pixelsOf(page);
  for (const [along, size_mm] of [['x', cloth_mm[0]], ['y', cloth_mm[1]]]) {
    const seen_mm = (extent(flat, box, along) * plane.mm) / plane.px;
    assert.ok(Math.abs(seen_mm / size_mm - 1) < 0.01, `${along}: ${seen_mm} mm are seen of ${size_mm}`);
  }
  await page.getByRole('button', {name: 'Ball'}).click();
  await page.waitForURL((url) => !url.search.includes('shape'));
  await drawn(page);
  const ball = await bar();
  const across_mm = (extent(await pixelsOf(page), box, 'x') * ball.mm) / ball.px;
  assert.ok(Math.abs((Math.PI * across_mm) / 2 / Math.min(...cloth_mm) - 1) < 0.01, `half around the ball are ${(Math.PI * across_mm) / 2} mm`);
  await visitor.leave();
});

test('each parameter says whether it is measured, derived or assumed, and what is assumed can be tried otherwise', async () => {
  const visitor = await visit(browser, archive, {width: 1000, height: 640});
  const page = await openMaterial(visitor);
  const {set: document} = await archive.ask(`sessions/weave/maps/${set.id}`);
  for (const {name, source} of document.maps) {
    const row = page.locator(`.parameters [data-name=${name === 'specular' ? 'f0' : name}]`);
    if (await row.count()) await row.getByText(source).first().waitFor();
  }
  assert.equal(await page.locator('.parameters [data-name=normal]').getByText('measured').count(), 1);
  assert.equal(await page.locator('.parameters [data-name=sheen]').getByText('assumed').count(), 1);
  assert.deepEqual(await violationsByWidth(page, 'material'), []);
  const before = await pixelsOf(page);
  await page.getByLabel('Sheen', {exact: true}).fill('1');
  await page.waitForURL(/sheen=1/);
  await drawn(page);
  assert.notDeepEqual((await pixelsOf(page)).data, before.data);
  await page.reload();
  await drawn(page);
  assert.equal(await page.getByLabel('Sheen', {exact: true}).inputValue(), '1');
  await visitor.leave();
});

test('the lamp turns the picture and asks for no map', async () => {
  const visitor = await visit(browser, archive, {width: 1000, height: 640});
  const page = await openMaterial(visitor);
  const asked = [];
  page.on('request', (request) => asked.push(request.url()));
  const before = await pixelsOf(page);
  const box = await page.locator('.material canvas').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.8, box.y + box.height / 2, {steps: 3});
  await page.mouse.up();
  await page.waitForURL(/light=0\.\d+%2C-?0(\.\d+)?%2C/);
  await drawn(page);
  const after = await pixelsOf(page);
  let changed = 0;
  for (let at = 0; at < after.data.length; at += 4) changed += Math.abs(after.data[at] - before.data[at]) > 4 ? 1 : 0;
  assert.ok(changed > 0.1 * box.width * box.height, `${changed} pixels changed`);
  assert.deepEqual(asked.filter((url) => url.includes('/tiles/')), []);
  await visitor.leave();
});

test('a plane that only scatters is as bright as the viewer shows it', async () => {
  const visitor = await visit(browser, archive, {width: 1000, height: 640});
  const page = await openMaterial(visitor, '?shape=plane&surroundings=0&f0=0');
  const box = await page.locator('.material canvas').boundingBox();
  const clip = {x: box.x + box.width / 2 - 120, y: box.y + box.height / 2 - 80, width: 240, height: 160};
  const material = luminanceOf(PNG.sync.read(await page.screenshot({clip})));
  await page.goto(`${archive.address}/viewer/weave/maps/${set.id}`);
  await drawn(page);
  const seen = await page.locator('.viewer canvas').boundingBox();
  const viewer = luminanceOf(PNG.sync.read(await page.screenshot({clip: {...clip, x: seen.x + seen.width / 2 - 120, y: seen.y + seen.height / 2 - 80}})));
  assert.ok(Math.abs(material / viewer - 1) < 0.03, `${material} and ${viewer}`);
  await visitor.leave();
});

async function choose(page, preset) {
  await page.getByRole('checkbox', {name: preset, exact: true}).check();
}

async function download(page, link) {
  const [file] = await Promise.all([page.waitForEvent('download'), link.click()]);
  return fs.readFileSync(await file.path());
}

test('the preset for Unreal leaves with its green down', async () => {
  const visitor = await visit(browser, archive, {width: 1200, height: 900});
  const page = await openMaterial(visitor, '?panel=export');
  await choose(page, 'unreal');
  await page.getByText('T_{name}_N.png').waitFor();
  await page.getByRole('button', {name: 'What it costs'}).click();
  await page.locator('.presets [data-preset=unreal] .files').getByText(/T_.*_N\.png/).waitFor({timeout: making_ms});
  await page.locator('.presets [data-preset=unreal]').getByText(/normals lose 0\.\d+°/).waitFor();
  assert.deepEqual((await archive.ask('sessions/weave/exports')).exports, [], 'nothing is written yet');
  await page.getByRole('button', {name: 'Export', exact: true}).click();
  const made = page.locator('.exported[data-preset=unreal]');
  await made.waitFor({timeout: making_ms});
  await made.getByText('green down').waitFor();
  assert.deepEqual(await violationsByWidth(page, 'material-export'), []);
  const normals = PNG.sync.read(await download(page, made.getByRole('link', {name: /_N\.png$/})));
  assert.deepEqual([normals.width, normals.height], [set.width, set.height]);
  let tilted = 0;
  for (let i = 0; i < 24; i++) {
    const [x, y] = [(37 * i + 11) % set.width, (53 * i + 7) % set.height];
    const {maps} = await archive.ask(`sessions/weave/maps/${set.id}/pixel?x=${x}&y=${y}`);
    const normal = Object.values(maps.normal);
    const [red, green] = normals.data.subarray(4 * (y * normals.width + x));
    assert.ok(Math.abs(red - 255 * (normal[0] / 2 + 0.5)) <= 1, `red ${red} at ${x}, ${y} of ${normal}`);
    assert.ok(Math.abs(green - 255 * (0.5 - normal[1] / 2)) <= 1, `green ${green} at ${x}, ${y} of ${normal}`);
    tilted += Math.abs(normal[1]) > 0.05 ? 1 : 0;
  }
  assert.ok(tilted > 5, 'a flat cloth would prove nothing');
  await visitor.leave();
});

/** The JSON of a .glb. */
function documentOf(glb) {
  assert.equal(glb.toString('latin1', 0, 4), 'glTF');
  return JSON.parse(glb.toString('utf8', 20, 20 + glb.readUInt32LE(12)));
}

test('who has left before a session says its maps or solves is not fetched back', async () => {
  const visitor = await visit(browser, archive);
  for (const [of, asks] of [['material/weave', /sessions\/weave\/maps$/], ['viewer/weave', /sessions\/weave\/solves$/]]) {
    const late = await visitor.hold(asks);
    const page = await visitor.open(`${archive.address}/${of}`);
    await late.asked;
    await page.getByRole('navigation').getByRole('link', {name: 'Library'}).click();
    await page.getByRole('heading', {level: 1, name: 'Library'}).waitFor();
    await late.arrive(page);
    assert.equal(new URL(page.url()).pathname, '/sessions');
  }
  await visitor.leave();
});

test('a session becomes a .glb of its true size without a terminal', async () => {
  const visitor = await visit(browser, archive, {width: 1100, height: 760});
  const page = await visitor.open(archive.address);
  await page.getByRole('navigation').getByRole('link', {name: 'Material'}).click();
  assert.deepEqual(await violations(page), []);
  await page.getByRole('list', {name: 'Cloths'}).getByRole('link', {name: 'swatch'}).click();
  await page.getByRole('button', {name: 'Make the maps'}).click();
  await page.waitForURL(/material\/swatch\/maps\/[0-9a-f]+/, {timeout: making_ms});
  await drawn(page);
  await page.getByRole('tab', {name: 'Export'}).click();
  await choose(page, 'glb');
  await page.getByRole('button', {name: 'Export', exact: true}).click();
  const made = page.locator('.exported[data-preset=glb]');
  await made.waitFor({timeout: making_ms});
  const glb = documentOf(await download(page, made.getByRole('link', {name: /\.glb$/})));
  const [one] = (await archive.ask('sessions/swatch/maps')).sets;
  const place = glb.accessors[glb.meshes[0].primitives[0].attributes.POSITION];
  const wide_m = place.max[0] - place.min[0];
  assert.ok(Math.abs(wide_m / (one.width * one.mm_per_pixel * 1e-3) - 1) < 1e-5, `${wide_m} m of ${one.width * one.mm_per_pixel} mm`);
  await visitor.leave();
});

test('a preview makes a draft that says so, and final maps are made of a better solve', async () => {
  const visitor = await visit(browser, archive, {width: 1100, height: 760});
  const page = await visitor.open(`${archive.address}/material/sketch`);
  await page.getByText('they are solved first').waitFor();
  await page.getByRole('button', {name: 'Only a draft'}).click();
  await page.waitForURL(/material\/sketch\/maps\/[0-9a-f]+/, {timeout: making_ms});
  await page.getByText('▲ A draft').waitFor();
  const draft = page.url();
  await page.getByRole('tab', {name: 'Export'}).click();
  await page.getByRole('checkbox', {name: /^Export the draft/}).waitFor();
  await page.getByRole('button', {name: 'Make the maps'}).click();
  await page.waitForURL((url) => /sketch\/maps\/[0-9a-f]+/.test(url.pathname) && !draft.includes(url.pathname), {timeout: making_ms});
  await page.getByText(/^(fast|standard|robust|reference) solve [0-9a-f]{8}$/).waitFor();
  assert.equal(await page.getByText('Stale').count(), 0);
  const {current, sets} = await archive.ask('sessions/sketch/maps');
  assert.notEqual(sets.find(({id}) => id === current).level, 'preview');
  await visitor.leave();
});

test('a material shows its layers and the files behind them, is built and looked at', async () => {
  const visitor = await visit(browser, archive, {width: 1100, height: 760});
  const page = await visitor.open(`${archive.address}/material`);
  await page.getByRole('list', {name: 'Materials'}).getByRole('link', {name: 'dusty'}).click();
  const dust = page.getByRole('list', {name: /^Layers/}).getByRole('listitem').filter({hasText: 'dust'}).first();
  await dust.getByText('50 %').waitFor();
  await dust.getByText('mask: 0.4').waitFor();
  await page.locator('summary').filter({hasText: 'Values of the material'}).click();
  const rough = page.getByRole('row', {name: /surface\.roughness/});
  await rough.getByText('dusty.toml').or(rough.getByText('library:dusty')).waitFor();
  await page.getByRole('row', {name: /surface\.cloth/}).getByText('library:cloth/wool').waitFor();
  assert.deepEqual(await violations(page), []);
  await page.getByRole('button', {name: 'Build'}).click();
  await page.getByRole('button', {name: 'Look at it'}).click({timeout: making_ms});
  await page.waitForURL(/material\/dusty\/builds\/[0-9a-f]+/);
  await drawn(page);
  await page.getByText('this is what its files say').waitFor();
  await picture(page, 'material_layers');

  await page.getByRole('checkbox', {name: 'dust is on'}).uncheck();
  await page.getByLabel('Save as').fill('clean');
  await page.getByRole('button', {name: 'Save', exact: true}).click();
  await page.waitForURL(/material\/clean\/builds/);
  await page.getByRole('list', {name: /^Layers/}).getByText('off').waitFor();
  const {generations} = await archive.ask('materials/clean');
  assert.deepEqual(generations.slice(1), ['library:dusty', 'library:cloth/wool']);
  await visitor.leave();
});

/** The mean of a picture in each channel, in linear light. */
function meansOf(shot) {
  const linear = (byte) => (byte <= 10 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
  const sums = [0, 0, 0];
  for (let at = 0; at < shot.data.length; at += 4) for (let c = 0; c < 3; c++) sums[c] += linear(shot.data[at + c]);
  return sums.map((sum) => sum / (shot.data.length / 4));
}

test('the highlights of a material have their colour', async () => {
  const visitor = await visit(browser, archive, {width: 1000, height: 640});
  const page = await visitor.open(`${archive.address}/material`);
  await page.getByRole('list', {name: 'Materials'}).getByRole('link', {name: 'golden'}).click();
  await page.getByRole('button', {name: 'Build'}).click();
  await page.getByRole('button', {name: 'Look at it'}).click({timeout: making_ms});
  await page.waitForURL(/material\/golden\/builds\/[0-9a-f]+/);
  await page.goto(`${page.url().split('?')[0]}?shape=plane&surroundings=0`);
  await page.getByText('Colour of highlights').waitFor();
  await drawn(page);
  const box = await page.locator('.material canvas').boundingBox();
  const clip = {x: box.x + box.width / 2 - 60, y: box.y + box.height / 2 - 40, width: 120, height: 80};
  const [r, g, b] = meansOf(PNG.sync.read(await page.screenshot({clip})));
  assert.ok(r > 0.02, `red ${r}`);
  assert.ok(Math.abs(g / r - 0.6) < 0.03 && Math.abs(b / r - 0.2) < 0.03, `green ${g / r}, blue ${b / r} of red`);
  await visitor.leave();
});
