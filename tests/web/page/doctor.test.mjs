// SPDX-License-Identifier: Apache-2.0
// The doctor: what is wrong, in words, with what mends it.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {after, before, test} from 'node:test';
import {picture, violations, violationsByWidth, visit} from './support/browser.mjs';
import {startRig, until} from './support/rig.mjs';
import {setUp, takeDown} from './support/setting.mjs';

let browser, rig;
before(async () => {
  ({browser, rig} = await setUp());
});
after(() => takeDown(browser, rig));

test('a board that is gone is told of with a remedy to copy, and is back when one asks again', async () => {
  await rig.inject('board unplug');
  const visitor = await visit(browser, rig);
  await visitor.context.grantPermissions(['clipboard-read', 'clipboard-write']);
  const page = await visitor.open(`${rig.address}/doctor`);
  const board = page.getByRole('listitem').filter({has: page.getByRole('heading', {name: 'board', exact: true})});
  await board.getByText('fault').waitFor();
  assert.deepEqual(await violations(page), []);
  await board.getByRole('button', {name: 'Copy'}).click();
  await board.getByRole('button', {name: 'Copied'}).waitFor();
  const {findings} = await rig.ask('doctor');
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), findings.find(({part}) => part === 'board').remedy);
  await rig.inject('board replug');
  await page.getByRole('button', {name: 'Examine again'}).click();
  await board.getByText('fault').waitFor({state: 'detached'});
  await visitor.leave();
});

test('one click shows what is hard in each stage, one more its pixels, and a key the condition of their lights', async () => {
  const visitor = await visit(browser, rig);
  const page = await visitor.open(`${rig.address}/doctor`);
  await page.getByRole('button', {name: 'Hard cases'}).click();
  const cases = page.getByRole('table', {name: 'Hard cases'});
  const three = cases.getByRole('row', {name: /three LEDs almost in a plane/});
  await three.getByText(/ILL_CONDITIONED/).waitFor();
  for (const stage of ['capture', 'calibration', 'solver', 'gloss', 'height', 'maps', 'export'])
    assert.ok(await cases.getByRole('cell', {name: stage, exact: true}).count() > 2, stage);
  await page.getByText(/0 off their bounds/).waitFor();
  assert.deepEqual(await violationsByWidth(page, 'hard-cases'), []);
  await page.getByRole('link', {name: 'Hard pixels in one picture'}).click();
  await page.waitForURL(/\/viewer\/torture\/[0-9a-f]+\?layer=status/);
  await page.getByRole('checkbox', {name: /ILL_CONDITIONED/, checked: true}).waitFor();
  await page.locator('canvas[data-ready=true]').waitFor();
  await page.keyboard.press('8');
  await page.getByRole('figure').getByText('Condition, decades').waitFor();
  await page.locator('canvas[data-ready=true]').waitFor();
  assert.deepEqual(await violations(page), []);
  await picture(page, 'torture');
  await visitor.leave();
});

test('the panel of a virtual rig pulls the board out and puts it in again', async () => {
  const visitor = await visit(browser, rig);
  visitor.mayFail(/status of 400/);
  const page = await visitor.open(`${rig.address}/doctor`);
  const board = page.getByRole('listitem').filter({has: page.getByRole('heading', {name: 'board', exact: true})});
  const panel = page.getByRole('complementary', {name: 'Virtual rig'});
  await page.getByText('This page').waitFor();
  await page.keyboard.press('?');
  await page.getByRole('dialog').getByText('break this virtual rig').waitFor();
  await page.keyboard.press('Escape');
  await page.getByRole('dialog').waitFor({state: 'detached'});
  await page.keyboard.press('V');
  await panel.getByRole('button', {name: 'board', exact: true}).click();
  await panel.getByRole('button', {name: 'board unplug'}).click();
  await panel.getByText('board unplug: done').waitFor();
  await picture(page, 'virtual-panel');
  await page.getByRole('button', {name: 'Examine again'}).click();
  await board.getByText('fault').waitFor();
  assert.deepEqual(await violations(page), []);

  await panel.getByLabel('Tell it').fill('light dead 77');
  await page.keyboard.press('Enter');
  await panel.getByText(/LEDs are 1 to/).waitFor();
  await panel.getByLabel('Tell it').fill('board replug');
  await page.keyboard.press('Enter');
  await panel.getByText('board replug: done').waitFor();
  await page.getByRole('button', {name: 'Examine again'}).click();
  await board.getByText('fault').waitFor({state: 'detached'});
  await page.keyboard.press('Escape');
  await page.keyboard.press('V');
  await panel.waitFor({state: 'detached'});
  await visitor.leave();
});

/** A process of the name that the desktop's program for cameras has. */
function desktopsProgram(folder) {
  const program = path.join(folder, 'gvfs-gphoto2-volume-monitor');
  fs.copyFileSync('/bin/sleep', program);
  return spawn(program, ['600'], {stdio: 'ignore'});
}

const rules = ['/etc', '/run', '/usr/local/lib', '/usr/lib', '/lib'].find((folder) => fs.existsSync(`${folder}/udev/rules.d/70-weft.rules`));
const skip = rules && `the udev rules in ${rules} keep such programs off`;

test('a camera that another program holds is told of at the desk and by the doctor, with what mends it', {skip}, async (t) => {
  const held = await startRig({options: ['--usb', '--away', '1']});
  t.after(() => held.stop());
  const thief = desktopsProgram(held.folder);
  t.after(() => thief.kill());
  await held.inject('camera usb_claimed');
  const visitor = await visit(browser, held);
  visitor.mayFail(/status of 503/);
  await visitor.context.grantPermissions(['clipboard-read', 'clipboard-write']);
  const page = await visitor.open(`${held.address}/desk`);
  await page.getByRole('button', {name: 'Live view'}).click();
  const complaint = page.getByRole('alert').filter({hasText: 'another program holds the camera'});
  await complaint.getByRole('button', {name: 'Copy'}).click();
  await complaint.getByRole('button', {name: 'Copied'}).waitFor();
  assert.match(await page.evaluate(() => navigator.clipboard.readText()), /gio mount -s gphoto2/);

  await page.getByRole('link', {name: 'Doctor', exact: true}).click();
  const camera = page.getByRole('listitem').filter({hasText: 'claims every camera'});
  await camera.getByText('systemctl --user mask --now gvfs-gphoto2-volume-monitor').waitFor();
  await camera.getByRole('button', {name: 'Copy'}).click();
  assert.match(await page.evaluate(() => navigator.clipboard.readText()), /^systemctl --user mask/);
  const gone = new Promise((resolve) => thief.once('exit', resolve));
  thief.kill();
  await gone;
  await page.getByRole('button', {name: 'Examine again'}).click();
  await camera.waitFor({state: 'detached'});

  await until(async () => (await held.ask('rig/devices', {open: true})).open);
  await page.getByRole('link', {name: 'Desk', exact: true}).click();
  await page.getByRole('button', {name: 'Live view'}).click();
  await page.getByRole('img', {name: 'Live view'}).waitFor();
  await visitor.leave();
});
