// SPDX-License-Identifier: Apache-2.0
// The first minutes: a server without a rig, and a rig that nobody has calibrated.
import {after, before, test} from 'node:test';
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
