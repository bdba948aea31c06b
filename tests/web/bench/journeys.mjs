// SPDX-License-Identifier: Apache-2.0
// What a person does from beginning to end, by keys and clicks that are counted, on a virtual rig of a megapixel.
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import {PNG} from 'pngjs';
import {Archive} from '../page/support/archive.mjs';
import {luminanceOf, visit} from '../page/support/browser.mjs';
import {startRig, until} from '../page/support/rig.mjs';

const root = fileURLToPath(new URL('../../../', import.meta.url));
const megapixels = 1;
const window = {width: 1280, height: 800};

/** A row: what is asked for is the most, or of frames a second the least. */
export function row(what, of_megapixels, reached, asked, isLeast = false) {
  return {what, megapixels: of_megapixels, reached: Number(reached.toPrecision(4)), asked, holds: isLeast ? reached >= asked : reached <= asked};
}

function tenths(thousandths) {
  return Math.round(thousandths / 100) / 10;
}

/** A hand that counts what it does. */
class Hand {
  #began = performance.now();
  actions = 0;

  constructor(page) {
    this.page = page;
  }

  /** Also by the words on it. */
  async click(what) {
    const button = typeof what === 'string' ? this.page.getByRole('button', {name: what}) : what;
    await button.click();
    this.actions++;
  }

  async press(key) {
    await this.page.keyboard.press(key);
    this.actions++;
  }

  get seconds() {
    return tenths(performance.now() - this.#began);
  }
}

async function newcomer(browser) {
  const rig = await startRig({megapixels});
  const visitor = await visit(browser, rig, window);
  const page = await visitor.context.newPage();
  const hand = new Hand(page);
  await page.goto(rig.address);
  await hand.click(page.getByRole('link', {name: 'Scan', exact: true}));
  await hand.press('n');
  await page.locator('#fabric').fill('shot silk');
  await hand.press('Enter');
  await hand.press('Space');
  await until(async () => (await rig.ask('rig')).phase === 'complete');
  const {seconds, actions} = hand;
  await visitor.leave();
  await rig.stop();
  return row(`newcomer: address to all photographs, ${actions} keys and clicks beside the name, s`, megapixels, seconds, 10);
}

async function lay(rig, hand, thing) {
  await rig.inject(`table ${thing}`);
  await hand.press('Space');
  const answer = hand.page.locator('.answer');
  await answer.waitFor({state: 'detached'});
  await answer.filter({hasText: 'taken'}).waitFor({timeout: 60_000});
}

async function calculate(hand, button) {
  await hand.click(button);
  await hand.page.locator('.result').waitFor({timeout: 120_000});
}

async function knock(browser) {
  const rig = await startRig({megapixels, options: ['--first', 'knock camera x=3 turn=0.4', '--first', 'knock led 3 x=6 z=-4']});
  const visitor = await visit(browser, rig, window);
  const page = await visitor.open(`${rig.address}/calibrate`);
  const hand = new Hand(page);
  await hand.click('After a knock');
  await hand.click('Begin, or go on');
  await page.locator('.set').waitFor();
  for (const pose of ['', ' tilt=20 azimuth=0', ' tilt=20 azimuth=90']) await lay(rig, hand, `sheet${pose}`);
  await calculate(hand, 'Calculate: what moved');
  await hand.click('Go on: fitted again');
  await calculate(hand, 'Calculate: fitted again');
  await hand.click('Go on: proof');
  await hand.click('Begin, or go on');
  await page.locator('.set').waitFor();
  for (const pose of [' turn=90', ' other=1', ' other=1 tilt=15 azimuth=210']) await lay(rig, hand, `sheet${pose}`);
  await calculate(hand, 'Calculate: proof');
  await hand.click("Make it the rig's");
  await page.getByText(/The rig scans by calibrations/).waitFor();
  const {seconds, actions} = hand;
  await visitor.leave();
  await rig.stop();
  return row(`knock to accepted, the sheet laid at once, ${actions} keys and clicks, no file, s`, megapixels, seconds, 180);
}

async function clothToMaterial(browser) {
  const archive = new Archive();
  await archive.add('silk', fs.readFileSync(path.join(root, 'testdata/scenes/demo.toml'), 'utf8'));
  await archive.serve();
  const visitor = await visit(browser, archive, window);
  const page = await visitor.open(`${archive.address}/material/silk`);
  const hand = new Hand(page);
  await hand.click('Make the maps');
  await hand.click(page.getByRole('tab', {name: 'Export'}));
  await hand.click(page.getByRole('checkbox', {name: 'glb', exact: true}));
  await hand.click(page.getByRole('button', {name: 'Export', exact: true}));
  await page.locator('.exported[data-preset=glb]').getByRole('link', {name: /\.glb$/}).waitFor({timeout: 120_000});
  const {seconds, actions} = hand;
  const {solves: [{width, height}]} = await archive.ask('sessions/silk/solves');
  await visitor.leave();
  await archive.stop();
  return row(`a demo's cloth to .glb with its solve, ${actions} clicks, s`, tenths((width * height) / 1e3), seconds, 25);
}

/** What is served, as app/server/page packs it. */
export function packedRows() {
  const dist = path.join(root, 'app/web/dist');
  const files = ['index.html', ...fs.readdirSync(path.join(dist, 'assets')).map((file) => `assets/${file}`)];
  const kilobytes = (names) => Math.round(names.reduce((sum, name) => sum + execFileSync('zopfli', ['-c', path.join(dist, name)]).length, 0) / 100) / 10;
  return [row('all of the page, packed, kB', 0, kilobytes(files), 110),
          row('what is loaded first, packed, kB', 0, kilobytes(files.filter((file) => /index|desk/.test(file))), 40)];
}

/** By a line of 400 kB a second: until it says that it loads, and until cloth is seen. */
export async function slowRows(browser, archive, address, of_megapixels) {
  const visitor = await visit(browser, archive, window);
  visitor.mayFail(/\/pixel\?/);
  const page = await visitor.context.newPage();
  const line = await visitor.context.newCDPSession(page);
  await line.send('Network.enable');
  await line.send('Network.emulateNetworkConditions', {offline: false, latency: 20, downloadThroughput: 400_000, uploadThroughput: 400_000});
  const began = performance.now();
  await page.goto(address, {waitUntil: 'commit'});
  await page.waitForFunction(() => {
    const shows = document.querySelector('main:empty, .picture:has([data-ready=false])');
    return shows && getComputedStyle(shows, '::after').content.includes('Loading');
  });
  const said_ms = performance.now() - began;
  while (luminanceOf(PNG.sync.read(await page.locator('canvas').screenshot())) < 0.01) await page.waitForTimeout(20);
  const seen_ms = performance.now() - began;
  await visitor.leave();
  return [row('400 kB/s: it says that it loads, ms', of_megapixels, Math.round(said_ms), 2000),
          row('400 kB/s: the cloth is seen, ms', of_megapixels, Math.round(seen_ms), 2000)];
}

export async function journeyRows(browser) {
  return [await newcomer(browser), await clothToMaterial(browser), await knock(browser)];
}
