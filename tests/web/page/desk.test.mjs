// SPDX-License-Identifier: Apache-2.0
// The desk: frame, focus, scan, look, next; and the room that stays dark.
import assert from 'node:assert/strict';
import {after, before, test} from 'node:test';
import {luminanceOf, picture, pixelsOf, violations, violationsByWidth, visit} from './support/browser.mjs';
import {mostToTell_ms, startRig, until} from './support/rig.mjs';
import {setUp, takeDown} from './support/setting.mjs';

const scanTakes_ms = 150_000;
const windows = [[1280, 720], [1920, 1080], [3840, 2160]];
let browser, rig, fine;
before(async () => {
  ({browser, rig} = await setUp());
});
after(async () => {
  await takeDown(browser, rig);
  await fine?.stop();
});

/** With fewer pixels the tags are too coarse for a finder. */
async function fineRig() {
  fine ??= await startRig({megapixels: 1});
  return fine;
}

/** The cursor is where the next cloth is named. */
async function atTheDesk(visitor, {address} = rig) {
  const page = await visitor.open(`${address}/desk`);
  await page.locator('#scan').waitFor();
  await page.keyboard.press('n');
  await page.locator('#fabric:focus').waitFor();
  return page;
}

/** In windows of each size: which of these are not wholly in the stage, with where they are. */
async function outOfStage(page, ...selectors) {
  const out = [];
  for (const [width, height] of windows) {
    await page.setViewportSize({width, height});
    await page.waitForTimeout(100);  // layout
    out.push(...await page.evaluate((those) => {
      const stage = document.querySelector('.desk .view').getBoundingClientRect();
      const within = ({left, top, right, bottom}, frame) => left >= frame.left - 1 && top >= frame.top - 1 && right <= frame.right + 1 && bottom <= frame.bottom + 1;
      const seen = those.flatMap((selector) => [...document.querySelectorAll(selector)].map((element) => [selector, element.getBoundingClientRect()]));
      const isMissing = those.filter((selector) => !document.querySelector(selector));
      const isOut = seen.filter(([, box]) => !within(box, stage) || !within(stage, new DOMRect(0, 0, innerWidth, innerHeight)));
      return [...isMissing, ...isOut.map(([selector, box]) => `${selector} in ${innerWidth} x ${innerHeight}: ${JSON.stringify(box)}`)];
    }, selectors));
  }
  return out;
}

/** That white paper, the brightest hundredth of a picture, is grey. */
async function showsWhite(picture) {
  await picture.evaluate((shown) => shown.decode?.());
  const [red, green, blue] = await picture.evaluate((shown) => {
    const canvas = new OffscreenCanvas(shown.naturalWidth ?? shown.width, shown.naturalHeight ?? shown.height);
    const context = canvas.getContext('2d');
    context.drawImage(shown, 0, 0);
    const {data} = context.getImageData(0, 0, canvas.width, canvas.height);
    const colours = Array.from({length: data.length / 4}, (_, at) => data.subarray(4 * at, 4 * at + 3));
    const bright = colours.sort((a, b) => b[1] - a[1]).slice(0, colours.length / 100);
    return [0, 1, 2].map((channel) => bright.reduce((sum, colour) => sum + colour[channel], 0) / bright.length);
  });
  assert.ok(Math.abs(red / green - 1) < 0.04 && Math.abs(blue / green - 1) < 0.04, `white paper is ${red}, ${green}, ${blue}`);
}

/** What lies over a button, at its middle and its corners. */
async function liesOver(button) {
  return button.evaluate((element) => {
    const {left, top, right, bottom} = element.getBoundingClientRect();
    const points = [[(left + right) / 2, (top + bottom) / 2], [left + 8, top + 8], [right - 8, top + 8], [left + 8, bottom - 8], [right - 8, bottom - 8]];
    const others = points.map(([x, y]) => document.elementFromPoint(x, y)).filter((other) => !element.contains(other));
    return others.map((other) => other?.className ?? 'it is out of the window');
  });
}

/** A scan of 13 shots takes 3.5 s as it is metered: this one is not over before somebody has looked at it. */
async function nameSlowScan(page, name) {
  await page.getByLabel('Exposure').fill('250');
  await page.getByLabel('Fabric').fill(name);
  await page.getByRole('button', {name: 'Scan'}).and(page.locator(':enabled')).waitFor();
}

/** By keys alone, from the name to the photographs. */
async function scanByKeys(page, name) {
  await page.keyboard.type(name);
  await page.getByRole('button', {name: 'Scan'}).and(page.locator(':enabled')).waitFor();
  await page.keyboard.press('Enter');
  await page.keyboard.press('Space');
  await page.getByRole('region', {name: 'Last scan'}).getByText(name, {exact: true}).waitFor({timeout: scanTakes_ms});
}

test('three swatches without a mouse: name, Enter, Space, next', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  for (const name of ['red satin', 'blue satin', 'green satin']) {
    await scanByKeys(page, name);
    await page.locator('#next-cloth:focus').waitFor();
    await page.keyboard.press('Space');
    await page.locator('#fabric:focus').waitFor();
    assert.equal(await page.getByLabel('Fabric').inputValue(), '');
  }
  const {sessions} = await rig.ask('sessions');
  assert.deepEqual(sessions.map(({fabric, state}) => [fabric, state]), [['green satin', 'complete'], ['blue satin', 'complete'], ['red satin', 'complete']]);
  await visitor.leave();
});

test('the name to come follows the fabric, and counts on where there is one', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  await page.keyboard.type('red satin');
  await page.getByText(/_red-satin_002$/).waitFor();
  await page.getByLabel('Fabric').fill('linen');
  await page.getByText(/_linen_001$/).waitFor();
  await visitor.leave();
});

test('the bill of a scan follows what is asked of it, and the scan takes what was billed', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  const bill = page.getByRole('region', {name: 'What the scan takes'});
  await page.keyboard.type('billed');
  await bill.getByText(/^13 shots/).waitFor();
  await bill.getByText('0.40° without, 0.0013° with').waitFor();
  await page.getByLabel('Repeat').uncheck();
  await bill.getByText(/^11 shots/).waitFor();
  assert.equal(await bill.getByText('0.0013° with').count(), 0);
  await page.getByLabel('Bracket').fill('0.25');
  await bill.getByText(/^21 shots/).waitFor();
  await page.getByRole('button', {name: 'Other shots'}).click();
  await page.getByRole('list', {name: 'Other shots'}).getByText(/^10 LEDs, repeat: the one to buy$/).waitFor();
  const repeated = page.getByRole('list', {name: 'Other shots'}).getByRole('button', {name: /^10 LEDs, repeat: /});
  assert.equal(await repeated.getAttribute('aria-pressed'), 'false');
  await repeated.focus();
  await page.keyboard.press('Enter');
  await bill.getByText(/^13 shots/).waitFor();
  assert.equal(await repeated.getAttribute('aria-pressed'), 'true');
  assert.deepEqual(await violations(page), []);
  await picture(page, 'desk-bill');
  await page.getByRole('button', {name: 'As the rig says'}).click();
  await bill.getByText(/^21 shots/).waitFor();

  await page.reload();
  await page.getByLabel('Fabric').fill('billed');
  await bill.getByText(/^21 shots/).waitFor();
  assert.equal(await page.getByLabel('Repeat').isChecked(), false);
  await page.keyboard.press('Enter');
  await page.keyboard.press('Space');
  await page.getByRole('region', {name: 'Last scan'}).waitFor({timeout: scanTakes_ms});
  const {sessions: [billed]} = await rig.ask('sessions?query=billed');
  const {frames} = await rig.ask(`sessions/${billed.name}`);
  const count = (role) => frames.filter((frame) => frame.role === role).length;
  assert.deepEqual(['lit', 'dark', 'repeat', 'bracket'].map(count), [10, 1, 0, 10]);
  await visitor.leave();
});

test('barcode, tags and height are kept with the scan', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  await page.getByLabel('Fabric').fill('denim');
  await page.getByLabel('Tags').fill('blue, raw');
  await page.getByLabel('Height').fill('1.5');
  await page.getByLabel('Barcode').fill('4006381333931');
  await page.keyboard.press('Enter');
  await page.locator('#scan:focus').waitFor();
  await page.keyboard.press('Space');
  await page.getByRole('region', {name: 'Last scan'}).waitFor({timeout: scanTakes_ms});
  const {sessions: [denim]} = await rig.ask('sessions?query=denim');
  assert.deepEqual([denim.id, denim.tags], ['4006381333931', ['blue', 'raw']]);
  assert.equal((await rig.ask(`sessions/${denim.name}`)).cloth_height_mm, 1.5);
  await visitor.leave();
});

test('after a scan there are ten photographs with their verdict and the relit cloth, and one LED is shot again', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  await scanByKeys(page, 'twill');
  const result = page.getByRole('region', {name: 'Last scan'});
  await result.getByText('good').nth(9).waitFor();
  await result.getByRole('img', {name: 'The cloth, relit'}).waitFor({timeout: scanTakes_ms});
  assert.deepEqual(await violationsByWidth(page, 'desk-scanned'), []);
  await showsWhite(result.getByRole('img', {name: 'Photograph: LED 1', exact: true}));
  assert.deepEqual(await outOfStage(page, '.preview', '.frame-card', '.price .button.main'), []);
  await result.getByRole('button', {name: 'Shoot LED 3 again'}).click();
  await page.locator('.dark').waitFor();
  await page.locator('.dark').waitFor({state: 'detached', timeout: scanTakes_ms});
  const {sessions: [twill]} = await rig.ask('sessions?query=twill');
  const {frames} = await rig.ask(`sessions/${twill.name}`);
  const first = frames.find(({led, role}) => led === 3 && role === 'lit');
  assert.notEqual(first.superseded_by, null);
  await visitor.leave();
});

test('what is over says so on its number, and the answer to one click is there in words', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  await page.getByLabel('Fabric').fill('white');
  await page.getByLabel('Exposure').fill('66.6667');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Space');
  const result = page.getByRole('region', {name: 'Last scan'});
  await result.getByText(/is over/).nth(9).waitFor({timeout: scanTakes_ms});
  await page.getByRole('list', {name: 'LEDs'}).getByText(/clipped/).nth(9).waitFor();
  await result.getByRole('button', {name: 'Shoot LED 7 again'}).click();
  await page.getByText('nobody measured the ratio').first().waitFor({timeout: scanTakes_ms});
  await page.getByText('scan the cloth again at another exposure').first().waitFor();
  await visitor.leave();
});

test('one click takes the LED that is over again, alone, at an exposure whose ratio was measured', async () => {
  rig.measureRatio(66_667, 16_667, 4);
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  await page.getByLabel('Fabric').fill('white');
  await page.getByLabel('Exposure').fill('66.6667');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Space');
  const result = page.getByRole('region', {name: 'Last scan'});
  const again = result.getByRole('button', {name: 'Shoot LED 7 again'});
  await again.and(page.getByText('Again at 17 ms')).click({timeout: scanTakes_ms});
  const bracket = result.getByRole('listitem').filter({hasText: 'LED 7 bracket'});
  await bracket.getByText(/good|near/).waitFor({timeout: scanTakes_ms});
  await page.getByRole('list', {name: 'LEDs'}).getByRole('button', {name: /^7 .*kept/}).waitFor();
  await picture(page, 'desk-over');
  const {sessions: [white]} = await rig.ask('sessions?query=white');
  const {frames} = await rig.ask(`sessions/${white.name}`);
  assert.deepEqual(frames.filter(({role}) => role === 'bracket').map(({led, exposure_us}) => [led, Math.round(exposure_us)]), [[7, 16667]]);
  await visitor.leave();
});

test('levels are priced, and one of them is queued', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  await scanByKeys(page, 'priced');
  await page.getByRole('button', {name: 'Measure the levels'}).click();
  await page.getByRole('button', {name: 'Queue fast'}).click({timeout: 2 * scanTakes_ms});
  await page.waitForFunction(async () => {
    const {jobs} = await (await fetch('/api/v1/jobs')).json();
    return jobs.some((job) => job.kind === 'solve' && job.by !== 'scan' && job.state === 'done');
  }, null, {timeout: scanTakes_ms, polling: 500});
  await visitor.leave();
});

test("the day's scans stand in the library, relit", async () => {
  await until(async () => (await rig.ask('jobs?limit=100')).jobs.every(({state}) => !['queued', 'running'].includes(state)));
  const complete = (await rig.ask('sessions')).sessions.filter(({state}) => state === 'complete');
  const visitor = await visit(browser, rig);
  const page = await visitor.open(`${rig.address}/sessions`);
  const [{name}] = complete;
  const newest = page.locator('.session').filter({hasText: name});
  await newest.locator('img[src$="/swatch.jpg"]').waitFor();
  await page.waitForFunction((count) => {
    const pictures = [...document.querySelectorAll('.session img')];
    return pictures.length === count && pictures.every((one) => one.naturalWidth > 0);
  }, complete.length);
  await picture(page, 'library');
  await visitor.leave();
});

test('from before the first exposure to the close of the last every tab is black and still', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  const other = await visitor.open(`${rig.address}/sessions`);
  await other.getByRole('heading', {level: 1}).waitFor();
  await page.bringToFront();
  await page.keyboard.press('Escape');
  await page.keyboard.press('v');
  await page.getByRole('img', {name: 'Live view'}).waitFor();
  await nameSlowScan(page, 'velvet');
  await page.keyboard.press('Enter');
  const lives = [];
  await page.keyboard.press('Space');
  await Promise.all([page, other].map((tab) => tab.locator('.dark').waitFor()));
  visitor.context.on('request', (request) => { if (/live|light/.test(request.url())) lives.push(request.url()); });
  const exposing = rig.ask('rig');
  const [first, elsewhere] = [await pixelsOf(page), await pixelsOf(other)];
  const second = await pixelsOf(page);
  assert.deepEqual([(await exposing).dark, (await rig.ask('rig')).dark], [true, true], 'the daemon says that it is dark');
  for (const pixels of [first, elsewhere]) {
    assert.ok(luminanceOf(pixels) < 0.0005, `mean luminance ${luminanceOf(pixels)}`);
  }
  assert.ok(first.data.equals(second.data), 'two pictures of the dark page differ');
  assert.deepEqual(lives, [], 'live view and light are let be');
  await page.locator('.dark').waitFor({state: 'detached', timeout: scanTakes_ms});
  const exposures = await rig.exposures();
  const {session} = await rig.ask('rig');
  assert.ok(exposures.length >= 11, `${exposures.length} exposures of ${session}`);
  await visitor.leave();
});

test('the dark is counted down to on every tab, and its end is heard once unless that is unwanted', async () => {
  const visitor = await visit(browser, rig);
  await visitor.context.addInitScript(() => {
    window.tones = 0;
    window.AudioContext = class extends AudioContext {
      constructor() {
        super();
        window.tones++;
      }
    };
    window.counted = [];
    new MutationObserver(() => {
      const said = document.querySelector('.soon')?.textContent ?? (document.querySelector('.dark') && 'dark');
      if (said && said !== window.counted.at(-1)) window.counted.push(said);
    }).observe(document, {subtree: true, childList: true, characterData: true});
  });
  const other = await visitor.open(`${rig.address}/sessions`);
  const page = await atTheDesk(visitor);
  await rig.ask('rig/devices', {open: true});  // which are there at once
  await page.getByText('devices open').waitFor();
  await scanByKeys(page, 'heard');
  for (const tab of [page, other]) {
    const counted = await tab.evaluate(() => window.counted);
    const of = ['Dark in 3', 'Dark in 2', 'Dark in 1', 'dark'];
    assert.deepEqual(counted, of.filter((one) => counted.includes(one)), 'it counts down');
    assert.equal(counted[0], 'Dark in 3');
    assert.equal(counted.at(-1), 'dark');
  }
  assert.equal(await page.evaluate(() => window.tones), 1);
  assert.equal(await other.evaluate(() => window.tones), 0, 'nobody has touched that page');
  await page.keyboard.press('n');
  await page.getByLabel('Tone at its end').uncheck();
  await page.keyboard.press('Escape');
  await page.keyboard.press('n');
  await scanByKeys(page, 'unheard');
  assert.equal(await page.evaluate(() => window.tones), 1);
  await visitor.leave();
});

test('a key at the dark page shows how long it takes, for two seconds', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  await nameSlowScan(page, 'how long');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Space');
  await page.locator('.dark').waitFor();
  await until(async () => (await rig.ask('rig')).left_s !== null);
  await page.keyboard.press('h');
  await page.locator('.dark').getByText(/\d of 13, \d+\.\d s left/).waitFor();
  await page.locator('.dark p').waitFor({state: 'detached'});
  await page.locator('.dark').waitFor({state: 'detached', timeout: scanTakes_ms});
  await visitor.leave();
});

test('a key at the dark page shows how things are for two seconds, and Escape and Enter cancel', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  await nameSlowScan(page, 'cancelled');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Space');
  await page.locator('.dark').waitFor();
  await page.keyboard.press('Escape');
  await page.getByText('Enter cancels the scan').waitFor();
  await page.keyboard.press('Enter');
  await page.locator('.dark').waitFor({state: 'detached', timeout: scanTakes_ms});
  await page.getByText('Goes on with').waitFor();
  await page.reload();
  await page.getByRole('button', {name: /^Go on with .*cancelled_001$/}).click();
  await page.getByRole('region', {name: 'Last scan'}).getByText('cancelled', {exact: true}).waitFor({timeout: scanTakes_ms});
  const {sessions} = await rig.ask('sessions?query=cancelled');
  assert.deepEqual(sessions.map(({state}) => state), ['complete'], 'the same session went on');
  await visitor.leave();
});

test('a key does what it says from the first, and types nothing', async () => {
  const visitor = await visit(browser, await fineRig(), {height: 720});
  const page = await visitor.open(`${fine.address}/desk`);
  await page.getByText('shows what the camera sees').waitFor();
  await page.keyboard.press('v');
  await page.getByRole('img', {name: 'Live view'}).waitFor();
  await page.keyboard.press('t');
  await page.locator('.test-shot').waitFor();
  assert.equal(await page.getByLabel('Fabric').inputValue(), '');
  await page.keyboard.press('Space');
  await page.locator('#fabric:focus').waitFor();
  await visitor.leave();
});

test('live view fits windows of every size with what is said of it, and nothing lies over Scan', async () => {
  const visitor = await visit(browser, await fineRig());
  const page = await atTheDesk(visitor, fine);
  await page.keyboard.type('a cloth with a bill');
  await page.getByRole('region', {name: 'What the scan takes'}).waitFor();
  await page.keyboard.press('Escape');
  await page.keyboard.press('v');
  await page.getByText(/4 of 4 tags in sight/).waitFor();
  assert.deepEqual(await outOfStage(page, '.finder canvas', '.finder figcaption', '.finder .tag'), []);
  await page.waitForFunction(() => document.querySelectorAll('.led.lit').length === 1);
  await showsWhite(page.locator('.finder canvas'));
  for (const [width, height] of windows) {
    await page.setViewportSize({width, height});
    await page.waitForTimeout(100);  // layout
    const [stage, shown, said] = await Promise.all(['.desk .view', '.finder canvas', '.finder figcaption'].map((one) => page.locator(one).boundingBox()));
    const filled = Math.max(shown.width / stage.width, shown.height / stage.height);
    assert.ok(filled > 0.93, `in ${width} x ${height} it fills ${filled} of its place`);
    assert.ok(said.y > shown.y && said.y + said.height < shown.y + shown.height, 'what is said of it lies on it');
    assert.ok(said.height > height / 80, `its text is ${said.height} of ${height} pixels high`);
    assert.deepEqual(await liesOver(page.locator('#scan')), [], `in ${width} x ${height}`);
    assert.deepEqual(await violations(page), []);
    await picture(page, `desk-live-${width}`);
  }
  await visitor.leave();
});

test('live view asks for one picture at a time, and for none while its tab is hidden', async () => {
  const visitor = await visit(browser, await fineRig());
  const page = await atTheDesk(visitor, fine);
  const asked = [];
  let atOnce = 0;
  let most = 0;
  const isFrame = (request) => request.url().includes('/rig/live/frame');
  page.on('request', (request) => { if (isFrame(request)) { asked.push(Date.now()); most = Math.max(most, ++atOnce); } });
  for (const end of ['requestfinished', 'requestfailed']) page.on(end, (request) => { if (isFrame(request)) atOnce--; });
  await page.keyboard.press('Escape');
  await page.keyboard.press('v');
  await page.getByRole('img', {name: 'Live view'}).waitFor();
  await page.keyboard.press('e');
  await page.getByRole('button', {name: 'Edges'}).and(page.locator('[aria-pressed=true]')).waitFor();
  await page.waitForFunction(() => document.querySelectorAll('.led.lit').length === 1);
  await page.getByText(/4 of 4 tags in sight, 0\.\d mm from where they belong/).waitFor();
  await picture(page, 'desk-live');
  assert.equal(most, 1);
  assert.deepEqual(await violations(page), []);
  await page.evaluate(() => {
    Object.defineProperty(document, 'hidden', {configurable: true, value: true});
    document.dispatchEvent(new Event('visibilitychange'));
  });
  const hidden = Date.now();
  await page.waitForFunction(async () => !(await (await fetch('/api/v1/rig/devices')).json()).live, null, {timeout: 10_000, polling: 200});
  assert.deepEqual(asked.filter((time) => time > hidden + 100), []);
  await visitor.leave();
});

test('a test shot tells exposure and focus, and a turned ring is seen', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  await page.keyboard.press('Escape');
  await page.keyboard.press('t');
  await page.locator('.dark').waitFor();
  await page.getByText('The first of its kind').waitFor({timeout: scanTakes_ms});
  await rig.inject('focus 3');
  await page.keyboard.press('t');
  await page.getByText(/of the sharpest, shot 1 of 2/).waitFor({timeout: scanTakes_ms});
  const [tile] = await page.locator('.loupe img').evaluateAll(async (pictures) => {
    await Promise.all(pictures.map((one) => one.decode()));
    return pictures.map(({naturalWidth}) => naturalWidth);
  });
  assert.equal(tile, 512, 'the loupe shows the photograph pixel by pixel');
  await showsWhite(page.getByRole('img', {name: /^Test shot \d+$/}));
  await picture(page, 'desk-focus');
  assert.deepEqual(await violations(page), []);
  assert.deepEqual(await outOfStage(page, '.overview', '.facts', '.loupe'), []);
  await rig.inject('focus 0');
  await visitor.leave();
});

test('a cable pulled at LED 7 is told of with its cause, and once it is back only what is missing is photographed', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  await nameSlowScan(page, 'cable');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Space');
  await until(async () => (await rig.ask('rig')).led >= 7);
  await rig.inject('board unplug');
  await page.getByRole('complementary', {name: 'Scan'}).getByText(/the LED board is not there|the LED board is gone/).waitFor();
  const {session} = await rig.ask('rig');
  const kept = async () => (await rig.ask(`sessions/${session}`)).frames.filter(({role}) => role === 'lit').map(({led, sha256}) => [led, sha256]);
  const before = await kept();
  const isOfBefore = (led) => before.some(([one]) => one === led);
  assert.ok(before.length >= 6 && before.length < 10, `${before.length} of ten were kept`);
  await rig.inject('board replug');
  await page.getByRole('region', {name: 'Last scan'}).getByText('cable', {exact: true}).waitFor({timeout: scanTakes_ms});
  assert.deepEqual((await kept()).filter(([led]) => isOfBefore(led)), before, 'those of before are kept');
  const {leds} = await rig.ask('rig');
  assert.deepEqual(leds.filter(({led, takes}) => isOfBefore(led) && takes > 1), []);
  await visitor.leave();
});

for (const [how, goOn] of [
  ['by its button', (page) => page.getByRole('button', {name: 'Go on'}).click()],
  ['by its key', (page) => page.keyboard.press('p')],
]) {
  test(`after a fault that is mended the same scan goes on ${how}, with all that it has`, async () => {
    const visitor = await visit(browser, rig);
    const page = await atTheDesk(visitor);
    await rig.inject('light dead 6');
    await page.getByLabel('Exposure').fill('10');
    await page.getByLabel('Fabric').fill(`fault ${how}`);
    await page.getByRole('button', {name: 'Scan'}).and(page.locator(':enabled')).waitFor();
    await page.keyboard.press('Enter');
    await page.keyboard.press('Space');
    await page.getByRole('button', {name: 'Go on'}).waitFor({timeout: scanTakes_ms});
    const {session} = await rig.ask('rig');
    const kept = async () => (await rig.ask(`sessions/${session}`)).frames.filter(({led}) => led > 0 && led < 6).map(({led, sha256}) => [led, sha256]);
    const before = await kept();
    assert.ok(before.length > 2, `${before.length} were kept`);
    await picture(page, 'desk-fault');
    await page.setViewportSize({width: 1280, height: 720});
    assert.deepEqual(await liesOver(page.getByRole('button', {name: 'Go on'})), []);
    assert.deepEqual(await liesOver(page.locator('#scan')), []);
    await page.getByLabel('Exposure').scrollIntoViewIfNeeded();
    assert.deepEqual(await liesOver(page.getByLabel('Exposure')), [], 'what is to be mended');
    await rig.inject('light normal');
    await goOn(page);
    await page.getByRole('region', {name: 'Last scan'}).getByText(`fault ${how}`, {exact: true}).waitFor({timeout: scanTakes_ms});
    assert.equal((await rig.ask('rig')).session, session, 'it is the same session');
    assert.deepEqual((await kept()).filter(([led, sha256]) => before.some((one) => one[0] === led && one[1] === sha256)), before);
    await visitor.leave();
  });
}

test('a daemon that dies while it is dark leaves the page light, and nothing claims that it photographs', async () => {
  const visitor = await visit(browser, rig);
  visitor.mayFail(/net::ERR_/);
  const page = await atTheDesk(visitor);
  await nameSlowScan(page, 'killed');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Space');
  await page.locator('.dark').waitFor();
  await until(async () => (await rig.ask('rig')).frames > 2);
  const {port} = rig;
  await rig.stopServing('SIGKILL');
  const dead = Date.now();
  await page.locator('.dark').waitFor({state: 'detached'});
  const took_ms = Date.now() - dead;
  assert.ok(took_ms < mostToTell_ms, `it took ${took_ms} ms`);
  await page.getByRole('alert').filter({hasText: /^The daemon/}).first().waitFor();
  assert.equal(await page.locator('header .rig').getByText(/photographing|fetching|ready/).count(), 0);
  await picture(page, 'desk-killed');
  await rig.serve({port});
  await page.locator('header .rig').getByText('ready').waitFor();
  await page.getByRole('button', {name: 'Scan'}).click();
  await page.getByRole('region', {name: 'Last scan'}).getByText('killed', {exact: true}).waitFor({timeout: scanTakes_ms});
  await visitor.leave();
});

test('what the meter of a test shot says is what a scan takes, and what is typed becomes a time of the camera', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  await scanByKeys(page, 'metered');
  const metered_us = (await rig.ask('rig')).exposure_us;
  await page.keyboard.press('n');
  const field = page.getByLabel('Exposure');
  await field.fill('100');
  await page.keyboard.press('Escape');
  await page.keyboard.press('t');
  await page.getByText('A scan would expose').waitFor({timeout: scanTakes_ms});
  await page.getByRole('button', {name: 'Use that'}).click();
  assert.equal(Number(await field.inputValue()), Number((metered_us / 1000).toPrecision(3)));
  await picture(page, 'desk-metered');

  await field.fill('16.16');
  await page.getByText('16.7 ms (1/60 s) is the camera\'s nearest.').waitFor();
  await page.keyboard.press('Tab');
  assert.equal(await field.inputValue(), '16.7');
  assert.ok(await page.locator('#exposure-list option').count() > 40, 'the times of the camera are listed');
  await field.fill('0.1');
  await page.getByText('The camera has 0.25 ms (1/4000 s) to 30 s.').waitFor();
  await page.getByLabel('Fabric').fill('as typed');
  assert.ok(await page.getByRole('button', {name: 'Scan'}).isDisabled());
  assert.deepEqual(await violations(page), []);
  await picture(page, 'desk-no-such-exposure');
  await field.fill('1/100');
  await page.keyboard.press('Enter');
  await page.getByRole('button', {name: 'Scan'}).and(page.locator(':enabled')).waitFor();
  await page.locator('#scan').focus();
  await page.keyboard.press('Space');
  await page.getByRole('region', {name: 'Last scan'}).getByText('as typed', {exact: true}).waitFor({timeout: scanTakes_ms});
  assert.equal(Math.round((await rig.ask('rig')).exposure_us), 10_000);
  await visitor.leave();
});

test('a dead LED, two swapped ones and a lamp are named in words, and the scan goes on once that is mended', async () => {
  const visitor = await visit(browser, rig);
  const page = await atTheDesk(visitor);
  const panel = page.getByRole('complementary', {name: 'Virtual rig'});
  const tell = async (line) => {
    await panel.getByLabel('Tell it').fill(line);
    await page.keyboard.press('Enter');
    await panel.getByText(`${line}: done`).waitFor();
  };
  await page.keyboard.press('Escape');
  await page.keyboard.press('V');
  for (const [line, says] of [
    ['light dead 3', 'LED 3 is dark'],
    ['light swap 4 5', /^LED 5 lights where LED 4 should and the other way round/],
    ['light ambient 0.3', /there is a lamp on in the room/],
  ]) {
    await tell(line);
    await page.getByLabel('Fabric').fill(line);
    await page.getByRole('button', {name: 'Scan'}).and(page.locator(':enabled')).waitFor();
    await page.keyboard.press('Enter');
    await page.keyboard.press('Space');
    await page.getByRole('complementary', {name: 'Scan'}).getByText(says).first().waitFor({timeout: scanTakes_ms});
    await tell('light normal');
  }
  await page.locator('#scan').focus();
  await page.keyboard.press('Space');
  await page.getByRole('region', {name: 'Last scan'}).getByText('light ambient 0.3', {exact: true}).waitFor({timeout: scanTakes_ms});
  await visitor.leave();
});
