// SPDX-License-Identifier: Apache-2.0
// What is around every screen: coming in, the connection, the tabs.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {luminanceOf, picture, pixelsOf, violationsByWidth, visit} from './support/browser.mjs';
import {mostToTell_ms} from './support/rig.mjs';
import {setUp, takeDown} from './support/setting.mjs';

const screens = ['desk', 'sessions', 'viewer', 'material', 'calibrate', 'jobs', 'doctor'];
let browser, rig;
before(async () => {
  ({browser, rig} = await setUp({names: ['rig.lan'], token: true}, '--host-resolver-rules=MAP rig.lan 127.0.0.1'));
});
after(() => takeDown(browser, rig));

/** Somebody who came in by the link. */
async function enter(visitor, screen = 'desk', address = rig.address) {
  const page = await visitor.open(`${address}/${screen}#${rig.token}`);
  await page.locator('header .rig').waitFor();
  return page;
}

test('the token of the link is taken off the address, and lets one in by a cookie', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor);
  assert.equal(new URL(page.url()).hash, '');
  assert.equal(await page.evaluate(() => document.cookie), '', 'no script reads the cookie');
  await page.goto(`${rig.address}/doctor`);
  await page.getByRole('heading', {level: 1}).waitFor();
  await visitor.leave();
});

test('who has no token is asked for it, and a wrong one is refused in words', async () => {
  const visitor = await visit(browser, rig);
  visitor.mayFail(/status of 401/);
  const page = await visitor.open(`${rig.address}/#wrong`);
  await page.getByText('asks for its token').waitFor();
  assert.equal(new URL(page.url()).hash, '');
  await page.getByLabel('Token or link').fill(`${rig.address}/#${rig.token}`);
  await page.keyboard.press('Enter');
  await page.locator('header .rig').waitFor();
  await visitor.leave();
});

test('by plain http from another name it works as well, where a browser offers no locks', async () => {
  const address = `http://rig.lan:${rig.port}`;
  const visitor = await visit(browser, rig, {origins: [address]});
  visitor.mayFail(/Cross-Origin-Opener-Policy header has been ignored/);
  const page = await enter(visitor, 'desk', address);
  assert.equal(await page.evaluate(() => navigator.locks), undefined, 'this context has locks: the test is void');
  await page.getByRole('status').filter({hasText: 'ready'}).waitFor();
  await visitor.leave();
});

test('a screen that is fetched later than the next one does not take its place', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor, 'doctor');
  await page.getByRole('heading', {level: 1, name: 'Doctor'}).waitFor();
  const late = await visitor.hold(/\/assets\/looks-[^/]*\.js$/);
  const tabs = page.getByRole('navigation');
  await tabs.getByRole('link', {name: 'Material'}).click();
  await late.asked;
  await tabs.getByRole('link', {name: 'Library'}).click();
  await page.getByRole('heading', {level: 1, name: 'Library'}).waitFor();
  await late.arrive(page);
  assert.equal(await page.getByRole('heading', {level: 1, name: 'Library'}).count(), 1);
  await visitor.leave();
});

for (const screen of screens) {
  test(`${screen} opens by its address, passes axe in windows of all widths, and is dark`, async () => {
    const visitor = await visit(browser, rig);
    const page = await enter(visitor, screen);
    await page.getByRole('heading', {level: 1}).waitFor({state: 'attached'});
    assert.deepEqual(await violationsByWidth(page, `${screen}-empty`), []);
    const luminance = luminanceOf(await pixelsOf(page));
    assert.ok(luminance < 0.015, `mean luminance ${luminance}`);
    await visitor.leave();
  });
}

test('an unknown address says so', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor);
  await page.evaluate(() => history.pushState(null, '', '/nowhere'));
  await page.evaluate(() => dispatchEvent(new PopStateEvent('popstate')));
  await page.getByRole('heading', {name: 'There is no page nowhere'}).waitFor();
  await visitor.leave();
});

test('ten tabs share one stream, and another one listens when the first is closed', async () => {
  const visitor = await visit(browser, rig);
  let streams = 0;
  visitor.context.on('request', (request) => { streams += request.url().includes('/api/v1/events'); });
  const pages = [];
  for (let tab = 0; tab < 10; tab++) pages.push(await enter(visitor, 'doctor'));
  assert.equal(streams, 1);
  const [first, ...others] = pages;
  const listens = visitor.context.waitForEvent('request', (request) => request.url().includes('/api/v1/events'));
  await first.close();
  await listens;
  await rig.ask('control', {name: 'Ann'});
  await Promise.all(others.map((page) => page.getByText('Ann has the controls').waitFor()));
  await visitor.leave();
});

test('when the daemon is stopped the page greys, and is back by itself once it answers', async () => {
  const visitor = await visit(browser, rig);
  visitor.mayFail(/net::ERR_/);
  const page = await enter(visitor);
  const {port} = rig;
  await rig.stopServing();
  const silence = page.getByText('The daemon has said nothing for');
  await silence.waitFor();
  await rig.serve({port});
  await silence.waitFor({state: 'detached'});
  await page.getByRole('status').filter({hasText: 'ready'}).waitFor();
  await visitor.leave();
});

test('without its daemon every screen says so and claims nothing of the rig', async () => {
  const visitor = await visit(browser, rig);
  visitor.mayFail(/net::ERR_/);
  const pages = [];
  for (const screen of screens) pages.push(await enter(visitor, screen));
  await Promise.all(pages.map((page) => page.locator('header .rig').getByText('ready').waitFor()));
  const {port} = rig;
  await rig.stopServing('SIGKILL');
  const dead = Date.now();
  await Promise.all(pages.map((page) => page.getByRole('alert').filter({hasText: /^The daemon (does not answer|has said nothing)/}).first().waitFor()));
  const took_ms = Date.now() - dead;
  assert.ok(took_ms < mostToTell_ms, `it took ${took_ms} ms`);
  for (const page of pages) assert.equal(await page.locator('header .rig').getByText('ready').count(), 0);
  await picture(pages[0], 'frame-silent');
  await rig.serve({port});
  await Promise.all(pages.map((page) => page.locator('header .rig').getByText('ready').waitFor()));
  await visitor.leave();
});

test('a daemon that hangs is told of', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor);
  await page.locator('header .rig').getByText('ready').waitFor();
  rig.hang(true);
  const hung = Date.now();
  await page.getByRole('alert').filter({hasText: 'The daemon has said nothing for'}).waitFor();
  const took_ms = Date.now() - hung;
  rig.hang(false);
  assert.ok(took_ms < mostToTell_ms, `it took ${took_ms} ms`);
  await page.locator('header .rig').getByText('ready').waitFor();
  await visitor.leave();
});

test('a screen that was first asked for while the daemon was gone is there once it is back', async () => {
  const visitor = await visit(browser, rig);
  visitor.mayFail(/net::ERR_/, /Failed to load resource/);
  const pages = [await enter(visitor), await enter(visitor, 'doctor'), await enter(visitor, 'sessions')];
  await pages[2].getByRole('link', {name: 'Doctor', exact: true}).click();  // whose screen is there already
  await pages[2].locator('main').getByRole('heading', {name: 'Doctor'}).waitFor();
  const {port} = rig;
  await rig.stopServing('SIGKILL');
  for (const page of pages) {
    await page.getByRole('link', {name: 'Library', exact: true}).click();
    await page.locator('main').getByRole('alert').waitFor();
  }
  await rig.serve({port});
  for (const page of pages) {
    await page.locator('main').getByRole('heading', {name: 'Library'}).waitFor();
    await page.locator('main').getByRole('alert').waitFor({state: 'detached'});
  }
  await visitor.leave();
});

test('who keeps the rig to himself is named, and one press gives it back to all', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor, 'doctor');
  await rig.ask('control', {name: 'Ann at a terminal'});
  await page.getByText('Ann at a terminal has the controls').waitFor();
  assert.equal((await rig.ask('rig/devices', {open: true})).error.code, 'controls_held');
  await page.getByRole('button', {name: 'Take the controls'}).click();
  await page.getByText('has the controls').waitFor({state: 'detached'});
  assert.equal((await rig.ask('rig/devices', {open: true})).open, true);
  await rig.ask('rig/devices', {open: false});
  await visitor.leave();
});

test('the keys are listed by ?, and none of them fires in a text field', async () => {
  const visitor = await visit(browser, rig);
  const page = await enter(visitor);
  await page.setViewportSize({width: 1280, height: 720});
  await page.locator('#scan').waitFor();
  await page.keyboard.press('n');
  await page.keyboard.type('what?');
  assert.equal(await page.getByLabel('Fabric').inputValue(), 'what?');
  assert.equal(await page.getByRole('dialog').count(), 0);
  await page.keyboard.press('Escape');
  await page.keyboard.press('?');
  await page.getByRole('dialog').getByText('full screen').waitFor();
  assert.equal(await page.getByRole('dialog').evaluate((dialog) => dialog.scrollTop), 0, 'it opens at its beginning');
  await page.keyboard.press('Escape');
  await page.getByRole('dialog').waitFor({state: 'detached'});
  await visitor.leave();
});
