// SPDX-License-Identifier: Apache-2.0
// The library: a wall of a thousand swatches, tags across tabs, edits that outlive the daemon, and one that cannot be read.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {after, before, test} from 'node:test';
import {picture, violations, violationsByWidth, visit} from './support/browser.mjs';
import {until} from './support/rig.mjs';
import {setUp, takeDown} from './support/setting.mjs';

const many = 1000;
/** Scanned, torn, of a newer weft. */
const others = 3;
const mostTiles = 60;
let browser, rig, scanned;
before(async () => {
  ({browser, rig} = await setUp({megapixels: 0.1}));
  await rig.inject('table cloth');
  scanned = await rig.scan('madder twill');
  writeSessions(path.join(rig.folder, 'scans'));
  await until(async () => (await rig.ask('sessions?limit=1')).total === others + many);
});
after(() => takeDown(browser, rig));

function writeSession(folder, name, text) {
  fs.mkdirSync(path.join(folder, `${name}.weft`), {recursive: true});
  fs.writeFileSync(path.join(folder, `${name}.weft`, 'session.json'), text);
}

/** Folders without photographs, the last of the first format, one of a format to come, one whose document is torn. */
function writeSessions(folder) {
  for (let index = 0; index < many; index++) {
    const name = `s${String(index).padStart(4, '0')}`;
    const document = {schema: 'weft.session/1.1', fabric: `cloth ${index}`, cloth_height_mm: 0.5, rig: 'another', calibration: '', state: 'complete', metadata: {tags: ['made']}, shots: []};
    writeSession(folder, name, JSON.stringify(document));
  }
  const old = {schema: 'weft.session/1', fabric: 'of the first format', cloth_height_mm: 0.5, rig: 'another', calibration: '', state: 'complete', shots: []};
  writeSession(folder, 's0999', JSON.stringify(old));
  writeSession(folder, 'newer', JSON.stringify({...old, schema: 'weft.session/2'}));
  writeSession(folder, 'torn', '{"schema": "weft.session/1.1", ');
}

async function enter(visitor, address = 'sessions') {
  const page = await visitor.open(`${rig.address}/${address}`);
  await page.getByRole('heading', {level: 1}).waitFor();
  return page;
}

function rowOf(page, name) {
  return page.locator('.session').filter({hasText: name});
}

test('of a thousand sessions at most sixty tiles exist, however one scrolls', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor);
  await page.getByText(`${many + others} sessions`).waitFor();
  await page.locator('.session').nth(8).waitFor();
  await picture(page, 'sessions');

  const list = page.locator('.virtual');
  const isFilled = () => document.querySelectorAll('.session a').length === document.querySelectorAll('.virtual li').length;
  for (const share of [0.1, 0.35, 0.7, 1]) {
    await list.evaluate((box, part) => box.scrollTo(0, part * box.scrollHeight), share);
    await page.waitForFunction(isFilled);
    const tiles = await page.locator('.virtual li').count();
    assert.ok(tiles <= mostTiles, `${tiles} tiles at ${share}`);
  }
  const last = page.locator(`.virtual li[aria-posinset="${many + others}"] a`);
  await last.waitFor();
  const [first, second, below] = await page.locator('.virtual li').evaluateAll((tiles) => {
    const places = tiles.map((tile) => tile.getBoundingClientRect());
    return [places[0], places[1], places.find(({top}) => top > places[0].top)].map(({left, top}) => ({left, top}));
  });
  assert.ok(second.left > first.left + 100 && second.top === first.top, `beside it: ${JSON.stringify([first, second])}`);
  assert.equal(below.left, first.left, 'the next row begins at the left');
  await visitor.leave();
});

test('the library passes axe, also with sessions chosen, at the width of a tablet', async () => {
  const visitor = await visit(browser, rig, {width: 900});
  const page = await enter(visitor);
  await page.locator('.session').first().getByRole('checkbox').check();
  await page.getByText('1 session chosen').waitFor();
  assert.deepEqual(await violationsByWidth(page, 'sessions'), []);
  await visitor.leave();
});

test('a tag that is given to two sessions is found in another tab, and taken back by Ctrl+Z', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor, 'sessions?words=wool');
  const other = await enter(visitor);
  await page.bringToFront();
  await page.getByText('No session is like that').waitFor();
  await page.keyboard.press('/');
  await page.keyboard.type('s000');
  for (const name of ['s0003', 's0007']) await rowOf(page, name).getByRole('checkbox').check();
  await page.getByLabel('Tags').fill('zebra');
  await page.getByRole('button', {name: 'Add'}).click();
  await rowOf(page, 's0007').getByText('zebra').waitFor();

  await other.getByLabel('Tag', {exact: true}).fill('zebra');
  await other.getByText('2 sessions').waitFor();

  await page.locator('h1').click();
  await page.keyboard.press('Control+z');
  await page.getByText(/^Undone: .*s00/).waitFor();
  await other.getByLabel('Tag', {exact: true}).fill('');
  await other.getByLabel('Tag', {exact: true}).fill('zebra');
  await other.getByText('1 session', {exact: true}).waitFor();
  await page.keyboard.press('Control+Shift+z');
  await page.getByText(/^Done again: /).waitFor();
  await visitor.leave();
});

test('a session that cannot be read is shown with its error and breaks nothing', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor, 'sessions?state=unreadable');
  const row = rowOf(page, 'torn');
  await row.waitFor();
  assert.match(await row.locator('.error').innerText(), /JSON|parse|read/i);
  assert.equal(await page.locator('.session').count(), 2);
  await visitor.leave();
});

test('a session of the first format opens, and one of a newer weft says which version it needs', async () => {
  const visitor = await visit(browser, rig);
  visitor.mayFail(/sessions\/newer/);
  const page = await enter(visitor, 'sessions?words=newer');
  const sentence = 'use a version of weft that reads weft.session/2';
  await rowOf(page, 'newer').getByText(sentence).waitFor();
  await page.getByRole('link', {name: 'newer'}).click();
  await page.getByRole('alert').getByText(sentence).waitFor();
  await page.goto(`${rig.address}/sessions/s0999`);
  await page.getByRole('heading', {name: 'of the first format'}).waitFor();
  await visitor.leave();
});

test('a scan is shown relit in the library, and left out where only scans that are not good are asked for', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor, 'sessions?words=madder');
  await until(async () => (await rig.ask('sessions?query=madder')).sessions[0].current_solve !== '');
  await page.reload();
  const relit = rowOf(page, scanned).locator('img[src$="/swatch.jpg"]');
  await relit.waitFor();
  await page.waitForFunction((image) => image.complete && image.naturalWidth > 40, await relit.elementHandle());
  assert.deepEqual(await relit.evaluate(({naturalWidth, naturalHeight}) => naturalWidth - naturalHeight), 0, 'a swatch is square');
  const warned = (await rig.ask('sessions?warned=true')).total;
  await page.getByRole('button', {name: 'Clear'}).click();
  await page.getByLabel('Not good').check();
  await page.getByText(warned === 1 ? '1 session' : `${warned} sessions`, {exact: true}).waitFor();
  await visitor.leave();
});

/** Share of the pixels of a picture that are nearly black or nearly white, as those of a tag. */
function shareOfInk(image) {
  const canvas = document.createElement('canvas');
  const [width, height] = [canvas.width = image.naturalWidth, canvas.height = image.naturalHeight];
  const context = canvas.getContext('2d');
  context.drawImage(image, 0, 0);
  const {data} = context.getImageData(0, 0, width, height);
  let ink = 0;
  for (let at = 0; at < data.length; at += 4) {
    const [least, most] = [Math.min(data[at], data[at + 1], data[at + 2]), Math.max(data[at], data[at + 1], data[at + 2])];
    if (most < 30 || least > 150) ink++;
  }
  return ink / (width * height);
}

test('a swatch is cloth: no tag and no white patch of the table is in it', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor, 'sessions?words=madder');
  const image = rowOf(page, scanned).locator('img');
  await image.waitFor();
  await page.waitForFunction((each) => each.complete && each.naturalWidth > 0, await image.elementHandle());
  const whole = (await image.getAttribute('src')).replace('swatch.jpg', 'tiles/relit/top/0_0.jpg');
  const swatch = await image.evaluate(shareOfInk);
  await image.evaluate((each, address) => new Promise((loaded) => { each.onload = loaded; each.src = address; }), whole);
  const frame = await image.evaluate(shareOfInk);
  assert.ok(frame > 0.01, `the whole frame has ${frame} of it`);
  assert.ok(swatch < 0.001, `${swatch} of the swatch is black or white`);
  await visitor.leave();
});

test('two swatches are compared: one dropped on the other, and both chosen by keys', async () => {
  const {session: second} = await rig.ask('scan', {fabric: 'madder again', cloth_height_mm: 0.8});
  await until(async () => (await rig.ask('rig')).phase === 'complete');
  await until(async () => (await rig.ask('sessions?query=madder')).sessions.every(({current_solve}) => current_solve !== ''));
  const visitor = await visit(browser, rig);
  const page = await enter(visitor, 'sessions?words=madder');
  await rowOf(page, scanned).waitFor();
  await picture(page, 'wall');
  await rowOf(page, second).locator('a').dragTo(rowOf(page, scanned));
  await page.waitForURL(new RegExp(`/viewer/${second}/.*with=${scanned}`));
  await page.getByLabel('Divider: this solve left').waitFor();
  await page.goBack();

  await rowOf(page, scanned).locator('a').focus();
  await page.keyboard.press('ArrowLeft');
  assert.ok(await rowOf(page, second).locator('a').evaluate((link) => link === document.activeElement), 'the newer is left of it');
  for (const name of [scanned, second]) {
    await rowOf(page, name).getByRole('checkbox').focus();
    await page.keyboard.press('Space');
  }
  await page.getByRole('button', {name: 'Compare'}).press('Enter');
  await page.waitForURL(/\/viewer\/.*with=/);
  await visitor.leave();
});

test('one that is not solved is not compared, and the page says so', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor, 'sessions?words=cloth+11');
  await rowOf(page, 's0011').locator('a').dragTo(rowOf(page, 's0110'));
  await page.getByText('cloth 11 is not solved yet').waitFor();
  await visitor.leave();
});

test('jobs are queued for each chosen session', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor, 'sessions?words=cloth+11');
  const names = ['s0011', 's0110'];
  for (const name of names) await rowOf(page, name).getByRole('checkbox').check();
  await page.getByRole('button', {name: 'Price'}).click();
  await page.getByText('2 jobs queued').waitFor();
  const {jobs} = await rig.ask('jobs?limit=20');
  assert.deepEqual(jobs.filter((job) => job.kind === 'price').map((job) => job.of).sort(), names);
  await visitor.leave();
});

test('one session shows its photographs and solves, and no change of somebody else is written over', async () => {
  await until(async () => (await rig.ask(`sessions/${scanned}/solves`)).solves.length > 0);
  const visitor = await visit(browser, rig);
  visitor.mayFail(/409.*metadata/);
  const page = await enter(visitor, `sessions/${scanned}`);
  await page.getByAltText('LED 10').waitFor();
  await page.getByText('in range').first().waitFor();
  await page.getByText('current').first().waitFor();
  assert.equal(await page.locator('.frames li').count(), 13);
  assert.deepEqual(await violationsByWidth(page, 'session'), []);

  await rig.ask(`sessions/${scanned}/metadata`, {notes: 'for the coat'});
  await page.getByLabel('Notes').fill('for the lining');
  await page.getByRole('button', {name: 'Save'}).click();
  const complaint = page.locator('.metadata .complaint');
  await complaint.waitFor();
  await complaint.getByRole('button', {name: 'Show what it is now'}).click();
  await page.waitForFunction(() => document.getElementById('field-notes')?.value === 'for the coat');
  await visitor.leave();
});

test('one button makes the maps and the export of a scan that has but a preview', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor, `sessions/${scanned}`);
  const chain = page.getByRole('region', {name: 'From photographs to files'});
  const rowOfChain = (name) => chain.getByRole('listitem').filter({has: page.getByText(name, {exact: true})});
  await rowOfChain('photographs').getByText('● fresh').waitFor();
  await rowOfChain('solve').getByText('a preview has half the size and no masks').waitFor();
  await rowOfChain('maps').getByText('none were made').waitFor();
  await chain.getByLabel('Export for').selectOption('png16');
  await chain.getByRole('button', {name: 'Make it final'}).click();
  for (const name of ['solve', 'maps', 'export']) await rowOfChain(name).getByText('● fresh').waitFor({timeout: 120000});
  assert.match(await rowOfChain('export').innerText(), /png16, of (fast|standard|robust|reference), [0-9.]+ degrees on [0-9]+ % of the cloth/);
  await chain.getByText('All of it is fresh.').waitFor();
  await chain.getByText('● good').waitFor({timeout: 120000});
  assert.deepEqual(await violationsByWidth(page, 'session-chain'), []);
  await visitor.leave();
});

test('two that were solved at different sizes say theirs, by name', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor, 'sessions?words=madder');
  const preview = page.locator('.session').filter({hasText: 'madder again'});
  await preview.locator('a').dragTo(rowOf(page, scanned));
  await page.getByText(/madder again has \d+ × \d+ pixels, madder twill has \d+ × \d+ pixels: solve both at one level/).waitFor();
  assert.deepEqual(await page.getByRole('alert').count(), 0, 'it is no error');
  assert.deepEqual(await violations(page), []);
  await visitor.leave();
});

test('twenty edits are undone after the daemon was restarted', async () => {
  const visitor = await visit(browser, rig);
  visitor.mayFail(/net::ERR_/);
  const page = await enter(visitor, 'sessions/s0500');
  await page.getByLabel('Notes').waitFor();
  for (let edit = 1; edit < 20; edit++) await rig.ask('sessions/s0500/metadata', {notes: `edit ${edit}`});
  await page.reload();
  await page.getByLabel('Notes').fill('edit 20');
  await page.getByRole('button', {name: 'Save'}).click();
  await page.getByText(/notes: edit 20/).waitFor();

  const {port} = rig;
  await rig.stopServing();
  await rig.serve({port});
  await page.locator('h1').click();
  for (let edit = 19; edit >= 0; edit--) {
    await page.keyboard.press('Control+z');
    await page.getByText(edit > 0 ? `Undone: notes: edit ${edit} of` : 'Undone: notes: none of').waitFor();
  }
  const {sessions: [session]} = await rig.ask('sessions?query=s0500');
  assert.equal(session.notes, '');
  await visitor.leave();
});
