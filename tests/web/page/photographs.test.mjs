// SPDX-License-Identifier: Apache-2.0
// Photographs that no rig took: from a folder with a light file to a file that engines open, in the page alone.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import {after, before, test} from 'node:test';
import zlib from 'node:zlib';
import {picture, violations, visit} from './support/browser.mjs';
import {until} from './support/rig.mjs';
import {setUp, takeDown} from './support/setting.mjs';

const width = 96, height = 72, lights = 8;
let browser, rig;
before(async () => {
  ({browser, rig} = await setUp({megapixels: 0.03}));
});
after(() => takeDown(browser, rig));

function chunk(kind, data) {
  const body = Buffer.concat([Buffer.from(kind), data]);
  const crc = Buffer.alloc(4), length = Buffer.alloc(4);
  crc.writeUInt32BE(crcOf(body));
  length.writeUInt32BE(data.length);
  return Buffer.concat([length, body, crc]);
}

function crcOf(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit++) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

/** Grey of 16 bits, which is linear. */
function png(light) {
  const head = Buffer.alloc(13), rows = Buffer.alloc(height * (1 + 2 * width));
  head.writeUInt32BE(width, 0);
  head.writeUInt32BE(height, 4);
  head.set([16, 0, 0, 0, 0], 8);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const slope = [0.4 * Math.cos(x / 5), 0.3 * Math.sin(y / 7), 1], size = Math.hypot(...slope);
      const shade = Math.max(0, slope.reduce((sum, value, axis) => sum + value * light[axis], 0) / size);
      rows.writeUInt16BE(Math.round(40000 * shade), y * (1 + 2 * width) + 1 + 2 * x);
    }
  }
  return Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), chunk('IHDR', head), chunk('IDAT', zlib.deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]);
}

function writePhotographs(folder) {
  fs.mkdirSync(folder);
  const lines = [String(lights)];
  for (let index = 0; index < lights; index++) {
    const turn = (2 * Math.PI * index) / lights, light = [0.6 * Math.cos(turn), 0.6 * Math.sin(turn), 0.8];
    fs.writeFileSync(path.join(folder, `${index}.png`), png(light));
    lines.push(`${index}.png ${light.join(' ')}`);
  }
  fs.writeFileSync(path.join(folder, 'coin.lp'), lines.join('\n'));
}

test('a folder of photographs becomes a session, is solved and leaves as .glb', async () => {
  writePhotographs(path.join(rig.folder, 'coin'));
  const visitor = await visit(browser, rig);
  visitor.mayFail(/status of 400/);
  const page = await visitor.open(`${rig.address}/sessions`);
  await page.getByText('Photographs of your own').click();
  await page.getByLabel('Folders').fill('no such folder');
  await page.getByRole('button', {name: 'Import', exact: true}).click();
  await page.getByRole('alert').getByText('must name a folder below').waitFor();

  await page.getByLabel('Folders').fill('coin');
  await picture(page, 'photographs');
  assert.deepEqual(await violations(page), []);
  await page.getByRole('button', {name: 'Import', exact: true}).click();
  await page.getByText('8 photographs of 96 x 72').waitFor();
  await page.getByRole('link', {name: 'coin', exact: true}).first().click();

  await page.getByRole('heading', {name: 'coin'}).waitFor();
  await page.waitForFunction((count) => [...document.querySelectorAll('.frames img, .frame img')].filter((image) => image.naturalWidth > 0).length === count, lights);
  await page.getByLabel('Export for').selectOption('glb');
  await page.getByRole('button', {name: 'Make it final'}).click();
  await page.getByText('All of it is fresh.').waitFor({timeout: 60_000});
  await picture(page, 'photographs-made');
  const made = path.join(rig.folder, 'scans/coin.weft/export/glb');
  assert.ok(fs.readdirSync(made).some((file) => file.endsWith('.glb')), fs.readdirSync(made).join());
  const [solve] = (await rig.ask('sessions/coin/solves')).solves;
  let pixel;
  await until(async () => (pixel = await rig.ask(`sessions/coin/solves/${solve.id}/pixel?x=40&y=40`)).readings);
  assert.equal(pixel.readings.readings.length, lights, JSON.stringify(pixel));
  await visitor.leave();
});
