// SPDX-License-Identifier: Apache-2.0
// The first minutes: a server without a rig, and a rig that nobody has calibrated.
import fs from 'node:fs';
import {after, before, test} from 'node:test';
import {Archive} from './support/archive.mjs';
import {launch, picture, violations, visit} from './support/browser.mjs';
import {serveArchive, serveByIcon, startRig} from './support/rig.mjs';
import assert from 'node:assert/strict';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

test('from the icon of the desktop to a .glb of a sample cloth in five minutes', async (t) => {
  const archive = await serveByIcon();
  t.after(() => archive.stop());
  const visitor = await visit(browser, archive);
  const page = await visitor.open(archive.opened);
  await page.getByText('This server has no rig').waitFor();
  await page.getByText('No cloth is solved here yet').waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, 'first-empty');
  const began = Date.now();
  await page.getByRole('button', {name: 'Try it without a rig'}).click();
  await page.getByText('Sample cloth:').waitFor();
  const canvas = page.locator('canvas[data-ready=true]');
  await canvas.waitFor({timeout: 120_000});
  t.diagnostic(`the sample cloth was there after ${((Date.now() - began) / 1000).toFixed(1)} s`);
  assert.deepEqual(await violations(page), []);
  await picture(page, 'first-sample');

  const lit = async (x, y) => {
    const {left, top, width} = await canvas.evaluate((element) => element.getBoundingClientRect());
    await page.mouse.move(left + x * width, top + y * width);
    await canvas.waitFor();
    return canvas.screenshot();
  };
  assert.notDeepEqual(await lit(0.95, 0.5), await lit(0.05, 0.5), 'the light follows the pointer');

  await page.getByRole('link', {name: 'see it on a ball'}).click();
  await page.waitForURL(/material\/sample\/maps/);
  await page.locator('canvas[data-ready=true]').waitFor();
  await page.getByRole('tab', {name: 'Export'}).click();
  await page.getByRole('checkbox', {name: 'glb', exact: true}).check();
  await page.getByRole('button', {name: 'Export', exact: true}).click();
  const link = page.locator('.exported[data-preset=glb]').getByRole('link', {name: /\.glb$/});
  const [file] = await Promise.all([page.waitForEvent('download', {timeout: 120_000}), link.click({timeout: 120_000})]);
  assert.equal(fs.readFileSync(await file.path()).toString('latin1', 0, 4), 'glTF');
  const seconds = (Date.now() - began) / 1000;
  t.diagnostic(`the .glb was there after ${seconds.toFixed(1)} s`);
  assert.ok(seconds < 300, `${seconds} s`);
  await visitor.leave();
});

const weave = `
fabric = "plain weave"
[camera]
width = 300
height = 200
[geometry]
kind = "plain"
[material]
albedo = 0.3
[effects]
near_light = true
relief = true
`;

test('without a rig a tour leads through a solved cloth to a rig of one\'s own', async (t) => {
  const archive = new Archive();
  t.after(() => archive.stop());
  await archive.add('weave', weave, 'fast');
  await archive.serve();
  const visitor = await visit(browser, archive);
  const page = await visitor.open(archive.address);
  const follow = async (step) => {
    await page.getByRole('link', {name: step, exact: true}).last().click();
    await page.waitForURL(/viewer|sessions|doctor/);
  };
  await page.getByRole('link', {name: 'Move the light'}).waitFor();
  await page.waitForFunction(() => [...document.querySelectorAll('.tour img')].every(({complete, naturalWidth}) => complete && naturalWidth > 0));
  const pictures = await page.locator('.tour ol img').count();
  assert.equal(pictures, await page.locator('.tour ol > li').count(), 'each step has a picture');
  assert.equal(pictures, 4);
  assert.deepEqual(await violations(page), []);
  await picture(page, 'tour');
  await page.keyboard.press('?');
  await page.getByRole('dialog').getByText('full screen').waitFor();
  assert.equal(await page.getByText('break this virtual rig').count(), 0, 'there is no rig to break');
  await page.keyboard.press('Escape');

  await follow('Move the light');
  await page.locator('canvas[data-ready=true]').waitFor();
  await page.goBack();
  await follow('Compare it with the truth');
  await page.locator('.marks .divider').waitFor({state: 'attached'});
  await page.goBack();
  await follow('Ask a pixel');
  await page.getByRole('rowheader', {name: '1', exact: true}).waitFor();
  await page.goBack();
  await follow('Find it again');
  await page.getByText('plain weave').first().waitFor();
  await page.getByRole('link', {name: 'Tour', exact: true}).click();
  await page.getByRole('button', {name: 'Copy'}).waitFor();
  await follow('doctor');
  await page.getByText('This page').waitFor();
  await visitor.leave();
});

test('an address that is none is answered by a page that says so, and /library is the library', async (t) => {
  const archive = await serveArchive();
  t.after(() => archive.stop());
  const visitor = await visit(browser, archive);
  visitor.mayFail(/404/);
  const page = await visitor.open(`${archive.address}/nope`);
  await page.getByRole('heading', {name: 'There is no page nope'}).waitFor();
  assert.deepEqual(await violations(page), []);
  await page.goto(`${archive.address}/library`);
  await page.getByRole('heading', {name: 'Library'}).waitFor();
  await visitor.leave();
});

test('a rig that has scanned nothing begins with ways on, and at its desk once it has', async (t) => {
  const rig = await startRig({megapixels: 0.03});
  t.after(() => rig.stop());
  const visitor = await visit(browser, rig);
  const page = await visitor.open(rig.address);
  await page.getByRole('link', {name: 'Scan', exact: true}).waitFor();
  assert.equal(new URL(page.url()).pathname, '/tour');
  assert.deepEqual(await violations(page), []);
  await rig.inject('table cloth');
  await rig.scan('first');
  await page.goto(rig.address);
  await page.waitForURL(/\/desk$/);
  await visitor.leave();
});

test('a rig without a calibration leads there first', async () => {
  const rig = await startRig({without: /^calibration = .*\n/m});
  const visitor = await visit(browser, rig);
  const page = await visitor.open(rig.address);
  await page.getByRole('link', {name: 'Scan', exact: true}).click();
  await page.getByText('not calibrated yet: camera, response, lights missing').waitFor();
  await picture(page, 'desk-uncalibrated');
  assert.deepEqual(await violations(page), []);
  await page.getByRole('link', {name: 'Calibrate it'}).click();
  await page.getByRole('heading', {level: 1}).waitFor();
  await visitor.leave();
  await rig.stop();
});
