// SPDX-License-Identifier: Apache-2.0
// The first minutes: a server without a rig, and a rig that nobody has calibrated.
import {after, before, test} from 'node:test';
import {Archive} from './support/archive.mjs';
import {launch, picture, violations, visit} from './support/browser.mjs';
import {serveArchive, startRig} from './support/rig.mjs';
import assert from 'node:assert/strict';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

test('a server without a rig says so, and leads to its sessions', async () => {
  const archive = await serveArchive();
  const visitor = await visit(browser, archive);
  const page = await visitor.open(archive.address);
  await page.getByText('This server has no rig').waitFor();
  assert.deepEqual(await violations(page), []);
  await page.getByRole('link', {name: 'Look at their sessions'}).click();
  await page.getByRole('heading', {name: 'Library'}).waitFor();
  await visitor.leave();
  await archive.stop();
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
    await page.getByRole('link', {name: step, exact: true}).click();
    await page.waitForURL(/viewer|sessions|doctor/);
  };
  await page.getByRole('link', {name: 'Move the light'}).waitFor();
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
  await page.goBack();
  await page.getByRole('button', {name: 'Copy'}).waitFor();
  await follow('doctor');
  await page.getByText('This page').waitFor();
  await visitor.leave();
});

test('a rig without a calibration leads there first', async () => {
  const rig = await startRig({without: /^calibration = .*\n/m});
  const visitor = await visit(browser, rig);
  const page = await visitor.open(rig.address);
  await page.getByText('not calibrated yet: camera, response, lights missing').waitFor();
  await picture(page, 'desk-uncalibrated');
  assert.deepEqual(await violations(page), []);
  await page.getByRole('link', {name: 'Calibrate it'}).click();
  await page.getByRole('heading', {level: 1}).waitFor();
  await visitor.leave();
  await rig.stop();
});
