// SPDX-License-Identifier: Apache-2.0
// The doctor: what is wrong, in words, with what mends it.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {picture, violations, visit} from './support/browser.mjs';
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

test('one click opens the torture scene with its status, and a key the condition of its lights', async () => {
  const visitor = await visit(browser, rig);
  const page = await visitor.open(`${rig.address}/doctor`);
  await page.getByRole('button', {name: 'Torture scene'}).click();
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
