// SPDX-License-Identifier: Apache-2.0
// The doctor: what is wrong, in words, with what mends it.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {violations, visit} from './support/browser.mjs';
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
