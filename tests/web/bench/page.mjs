// SPDX-License-Identifier: Apache-2.0
// How long a person waits for the page, drawn by software, and what a day's work takes: `weft bench page` runs
// this on folders of sessions and reads its rows. Milliseconds by the clock on the wall: nothing else should run.
import fs from 'node:fs';
import path from 'node:path';
import {Archive} from '../page/support/archive.mjs';
import {launch, visit} from '../page/support/browser.mjs';
import {startRig} from '../page/support/rig.mjs';
import {journeyRows, packedRows, row, slowRows} from './journeys.mjs';

const minutes = Number(process.env.WEFT_MINUTES ?? 0);  // that it pans
const solve = {session: 'wide', id: '0123456789abcdef'};
const places = [[0.2, 0.2], [0.8, 0.3], [0.3, 0.8], [0.7, 0.7], [0.5, 0.2]];
const window = {width: 1280, height: 720};

function median(values) {
  return [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
}

async function whole(page) {
  await page.locator('canvas[data-ready=true]').waitFor();
}

async function opened(visitor, address, wait) {
  const page = await visitor.context.newPage();
  const began = performance.now();
  await page.goto(address);
  await wait(page);
  return {page, ms: performance.now() - began};
}

/** Frames a second while the light goes round under a hand. */
async function dragLight(page) {
  const box = await page.locator('canvas').boundingBox();
  await page.keyboard.press('l');
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  const rate = await page.locator('canvas').evaluate((canvas) => new Promise((done) => {
    const bounds = canvas.getBoundingClientRect();
    const began = performance.now();
    let frames = 0;
    const turn = (now) => {
      if (now - began > 3000) return done((1000 * frames) / (now - began));
      frames++;
      const clientX = bounds.x + bounds.width * (0.5 + 0.3 * Math.cos(frames / 9));
      const clientY = bounds.y + bounds.height * (0.5 + 0.3 * Math.sin(frames / 9));
      canvas.dispatchEvent(new PointerEvent('pointermove', {pointerId: 1, clientX, clientY, bubbles: true}));
      requestAnimationFrame(turn);
    };
    requestAnimationFrame(turn);
  }));
  await page.mouse.up();
  await page.keyboard.press('l');
  return rate;
}

/** From a jump to another place at 1:1 to all of its tiles. */
async function jump(page, query) {
  return page.evaluate((words) => new Promise((done) => {
    const began = performance.now();
    history.replaceState(null, '', `?${words}`);
    dispatchEvent(new PopStateEvent('popstate'));
    const canvas = document.querySelector('canvas');
    const watch = () => (canvas.dataset.ready === 'true' ? done(performance.now() - began) : requestAnimationFrame(watch));
    requestAnimationFrame(watch);
  }), query);
}

async function newPlaces(page, size) {
  const times = [];
  for (const [x, y] of places) times.push(await jump(page, `view=${Math.round(x * size.width)},${Math.round(y * size.height)},1`));
  return median(times);
}

/** A hand that pans over the whole map at 1:1, back and forth in both ways, for a minute. */
async function panAMinute(page, size) {
  const box = await page.locator('canvas').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.locator('canvas').evaluate((canvas, {width, height}) => new Promise((done) => {
    const bounds = canvas.getBoundingClientRect();
    const began = performance.now();
    const move = (now) => {
      const seconds = (now - began) / 1000;
      if (seconds > 60) return done();
      const clientX = bounds.x + bounds.width / 2 - (width / 2) * Math.sin((2 * Math.PI * seconds) / 60);
      const clientY = bounds.y + bounds.height / 2 - (height / 2) * Math.sin((2 * Math.PI * seconds) / 20);
      canvas.dispatchEvent(new PointerEvent('pointermove', {pointerId: 1, clientX, clientY, bubbles: true}));
      requestAnimationFrame(move);
    };
    requestAnimationFrame(move);
  }), size);
  await page.mouse.up();
}

/** Megabytes of the page's heap and of the process that draws. */
async function memoryOf(browser, page) {
  const asks = await browser.newBrowserCDPSession();
  const {processInfo} = await asks.send('SystemInfo.getProcessInfo');
  await asks.detach();
  const gpu = processInfo.find(({type}) => type === 'GPU');
  const [, kilobytes] = fs.readFileSync(`/proc/${gpu.id}/status`, 'utf8').match(/VmRSS:\s+(\d+)/);
  const heap = await page.evaluate(() => performance.memory.usedJSHeapSize);
  return heap / 1e6 + (1024 * Number(kilobytes)) / 1e6;
}

async function panningRows(browser, page, size, megapixels) {
  const rows = [];
  await jump(page, `view=${size.width / 2},${size.height / 2},1`);
  for (let minute = 1; minute <= minutes; minute++) {
    await panAMinute(page, size);
    rows.push(row(`heap and drawing after ${minute} min of panning, MB`, megapixels, await memoryOf(browser, page), 700));
  }
  return rows;
}

async function viewerRows(browser, folder) {
  const archive = new Archive(path.resolve(folder));
  await archive.serve();
  const visitor = await visit(browser, archive, window);
  visitor.mayFail(/\/pixel\?/);  // these sessions have maps and no photographs
  const size = await archive.ask(`sessions/${solve.session}/solves/${solve.id}`);
  const megapixels = Math.round((size.width * size.height) / 1e6);
  const {page, ms} = await opened(visitor, `${archive.address}/viewer/${solve.session}/${solve.id}`, whole);
  const rows = [
    row('first view, ms', megapixels, ms, megapixels > 50 ? 3000 : 2000),
    row('light under a hand, frames a second', megapixels, await dragLight(page), 25, true),
    row('a new place at 1:1, ms', megapixels, await newPlaces(page, size), 300),
    ...await panningRows(browser, page, size, megapixels),
    ...await slowRows(browser, archive, `${archive.address}/viewer/${solve.session}/${solve.id}`, megapixels),
  ];
  await visitor.leave();
  await archive.stop();
  return rows;
}

async function deskRow(browser) {
  const rig = await startRig();
  const visitor = await visit(browser, rig, window);
  const {ms} = await opened(visitor, `${rig.address}/desk`, (page) => page.locator('#fabric').waitFor());
  await visitor.leave();
  await rig.stop();
  return row('the desk can be used, ms', 0, ms, 1500);
}

const browser = await launch();
const rows = [...packedRows(), await deskRow(browser), ...await journeyRows(browser)];
for (const folder of process.argv.slice(2)) rows.push(...await viewerRows(browser, folder));
await browser.close();
console.log(JSON.stringify(rows));
