// SPDX-License-Identifier: Apache-2.0
// Jobs: what each level costs and gives, one job however often it is asked for, and the queue as two people see it.
import assert from 'node:assert/strict';
import {execFile} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {after, before, test} from 'node:test';
import {promisify} from 'node:util';
import {violationsByWidth, visit} from './support/browser.mjs';
import {until, weft} from './support/rig.mjs';
import {setUp, takeDown} from './support/setting.mjs';

const run = promisify(execFile);
const price_ms = 120_000;
let browser, rig, session;
before(async () => {
  ({browser, rig} = await setUp({megapixels: 0.1}));
  await rig.inject('table cloth');
  session = await rig.scan('madder twill');
  await until(async () => (await jobsOf('solve')).some((job) => job.state === 'done'));
});
after(() => takeDown(browser, rig));

async function jobsOf(kind) {
  return (await rig.ask('jobs?limit=50')).jobs.filter((job) => job.kind === kind);
}

async function pricePage(visitor) {
  const page = await visitor.open(`${rig.address}/jobs?price=${session}`);
  await page.getByRole('heading', {name: 'Accuracy against time'}).waitFor();
  return page;
}

/** The degrees of each level, as the table writes them. */
async function tableOf(page) {
  const rows = await page.locator('.price tbody tr').all();
  return Promise.all(rows.map(async (row) => [await row.locator('th').innerText(), ...(await row.locator('td').allInnerTexts()).slice(1, 5)]));
}

function degrees(value) {
  if (value === 0) return '0°';
  return `${value.toFixed(Math.min(6, Math.max(0, 1 - Math.floor(Math.log10(Math.abs(value))))))}°`;
}

test('the levels are priced as the command prices them, as a table and as points', async () => {
  const visitor = await visit(browser, rig, {height: 1400});
  const page = await pricePage(visitor);
  await page.getByRole('button', {name: 'Measure the levels'}).click();
  await page.getByRole('button', {name: 'Queue standard'}).waitFor({timeout: price_ms});
  const folder = path.join(rig.folder, 'scans', `${session}.weft`);
  const {stdout} = await run(weft, ['solve', folder, '--explain', '--json'], {env: rig.environment});
  const share = (solved) => (solved === 1 ? '100 %' : solved >= 0.995 ? 'over 99 %' : `${Math.round(100 * solved)} %`);
  const expected = JSON.parse(stdout).levels.map(({quality, predicted_deg, solved, parts_deg}) => [
    quality, `${degrees(predicted_deg)} on ${share(solved)}`, ...[parts_deg.noise, parts_deg.model, parts_deg.calibration].map(degrees),
  ]);
  assert.deepEqual(await tableOf(page), expected);
  const {recommended} = (await jobsOf('price'))[0].result;
  await page.getByRole('row', {name: new RegExp(`^${recommended}.*the one to buy`)}).waitFor();
  assert.equal(await page.getByText('the one to buy').count(), 1);
  assert.equal(await page.locator('.ladder .level').count(), expected.length);
  await page.waitForFunction((count) => [...document.querySelectorAll('.crops img')].filter((crop) => crop.naturalWidth > 0).length === count, expected.length);
  assert.deepEqual(await violationsByWidth(page, 'jobs-price'), []);
  await visitor.leave();
});

test('two clicks are one job, by the table and by a point of the plot', async () => {
  const visitor = await visit(browser, rig);
  const page = await pricePage(visitor);
  await page.getByRole('button', {name: 'Queue fast'}).dblclick();
  await page.locator('.ladder .level', {hasText: 'fast'}).press('Enter');
  await page.locator('.ladder .level', {hasText: 'preview'}).locator('.target').click();
  await until(async () => (await jobsOf('solve')).filter((job) => job.state === 'done').length >= 3);
  assert.equal((await jobsOf('solve')).length, 3, 'the quick solve, fast and preview');
  await page.getByRole('link', {name: 'Look at it'}).nth(1).waitFor();
  await visitor.leave();
});

test('the queue is the same in another browser: put first, cancelled, done again, read', async () => {
  const [ann, bob] = await Promise.all([visit(browser, rig), visit(browser, rig)]);
  const page = await pricePage(ann);
  for (const level of ['reference', 'standard', 'preview']) await page.getByRole('button', {name: `Queue ${level}`}).click();
  const theirs = await bob.open(`${rig.address}/jobs`);
  const [last, second] = await jobsOf('solve');
  await theirs.getByRole('button', {name: `Put ${last.id} first`}).click();
  await theirs.getByRole('button', {name: `Cancel ${second.id}`}).click();
  await page.getByRole('button', {name: `Do ${second.id} again`}).waitFor();
  await until(async () => (await rig.ask(`jobs/${last.id}`)).state === 'done');
  const cancelled = await rig.ask(`jobs/${second.id}`);
  assert.equal(cancelled.state, 'cancelled');
  assert.equal(cancelled.began, '', 'it was taken out of the queue');
  const solves = fs.readdirSync(path.join(rig.folder, 'scans', `${session}.weft`, 'solve'));
  assert.ok(solves.every((name) => !name.startsWith('.') && !name.includes('partial')), `left behind: ${solves}`);

  await page.getByRole('button', {name: `Do ${second.id} again`}).click();
  await until(async () => (await jobsOf('solve'))[0].state === 'done');
  await page.getByRole('button', {name: `Log of ${last.id}`}).click();
  assert.notEqual(await page.getByRole('dialog').getByLabel('Log').innerText(), '');
  await page.keyboard.press('Escape');
  await page.getByRole('button', {name: `Forget ${second.id}`}).click();
  await page.getByRole('button', {name: `Forget ${second.id}`}).waitFor({state: 'detached'});
  assert.deepEqual(await violationsByWidth(theirs, 'jobs'), []);
  await Promise.all([ann.leave(), bob.leave()]);
});

/** A solve that takes ten times as long as others, so that a scan can begin meanwhile. */
function longSolve() {
  return rig.ask('jobs', {kind: 'solve', session, method: 'seed'});
}

/** How far a job is, as the page shows it. */
async function shareShown(visitor, id) {
  const page = await visitor.open(`${rig.address}/jobs`);
  return Number(await page.getByRole('progressbar', {name: `Job ${id}`, exact: true}).getAttribute('value'));
}

test('another browser shows the share that the closed one showed, and a job that is cancelled while it runs leaves nothing', async () => {
  const folder = path.join(rig.folder, 'scans', `${session}.weft`);
  const entries = () => fs.readdirSync(folder, {recursive: true}).sort();
  const before = entries();
  const {id} = await longSolve();
  const job = () => rig.ask(`jobs/${id}`);
  await until(async () => { const {phase, share} = await job(); return phase === 'solve' && share > 0; });
  // A slow scan, so that it holds the job before its board is gone, and until it is back.
  const {session: holding} = await rig.ask('scan', {fabric: 'holds the job', cloth_height_mm: 0.8, exposure_us: 250_000});
  assert.ok(holding, 'the scan began');
  await until(async () => (await job()).held);
  await rig.inject('board unplug');
  const first = await visit(browser, rig);
  const share = await shareShown(first, id);
  await first.leave();
  const second = await visit(browser, rig);
  assert.equal(await shareShown(second, id), share);
  assert.equal((await job()).share, share);
  assert.ok(share > 0 && share < 1, `${share}`);

  const [page] = second.context.pages();
  await page.getByRole('button', {name: `Cancel ${id}`}).click();
  await page.getByRole('button', {name: `Do ${id} again`}).waitFor();
  assert.equal((await job()).state, 'cancelled');
  assert.deepEqual(entries(), before, 'what a job leaves behind');
  await second.leave();
  await rig.ask('scan/cancel', {});
  await rig.inject('board replug');
  await until(async () => (await rig.ask('rig')).can.includes('scan'));
});

test('a scan that begins during a solve loses no photograph, and the solve stands still meanwhile', async () => {
  const before = await rig.ask(`sessions/${session}`);
  const {id} = await longSolve();
  await until(async () => (await rig.ask(`jobs/${id}`)).phase === 'solve');
  const {session: beside} = await rig.ask('scan', {fabric: 'beside a solve', cloth_height_mm: 0.8});
  const seen = [];
  await until(async () => {
    const {session: scanned, phase, frames} = await rig.ask('rig');
    if (scanned !== beside) return false;
    if (frames > 0 && phase !== 'complete') seen.push(await rig.ask(`jobs/${id}`));
    return phase === 'complete';
  });
  assert.ok(seen.length > 2, `looked ${seen.length} times`);
  assert.deepEqual(new Set(seen.map(({held, phase, share, seconds}) => `${held} ${phase} ${share} ${seconds}`)).size, 1, 'it stood still');
  assert.equal(seen[0].held, true);
  const {leds} = await rig.ask('rig');
  assert.deepEqual(leds.map(({state, takes}) => [state, takes]), leds.map(() => ['kept', 1]));
  const {frames} = await rig.ask(`sessions/${beside}`);
  assert.deepEqual(frames.map(({led, role}) => [led, role]), before.frames.map(({led, role}) => [led, role]));
  await until(async () => (await rig.ask(`jobs/${id}`)).state === 'done');
});
