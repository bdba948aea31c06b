// SPDX-License-Identifier: Apache-2.0
// The wizard: a board seen and not seen, and a rig that was knocked brought back, with nothing but the page.
import assert from 'node:assert/strict';
import {execFile} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import {after, before, test} from 'node:test';
import {promisify} from 'node:util';
import {launch, picture, violations, violationsByWidth, visit} from './support/browser.mjs';
import {startRig, weft} from './support/rig.mjs';

const run = promisify(execFile);
const isSoak = process.env.WEFT_SOAK !== undefined;
const photograph_ms = 60_000;
const calculation_ms = 120_000;
let browser;
before(async () => { browser = await launch(); });
after(async () => { await browser?.close(); });

function described(rig, thing) {
  return path.join(rig.folder, 'targets', `${thing}.toml`);
}

/** The fields of a board as a person types them. */
async function fillBoard(page, file) {
  for (const [, name, value] of fs.readFileSync(file, 'utf8').matchAll(/^(\w+) *= *"?([^"\n#]+?)"? *(?:#.*)?$/gm)) {
    if (name === 'kind') await page.getByLabel('Kind').selectOption(value);
    else await page.locator(`#board-${name}`).fill(value);
  }
}

/** What lies there is said in the form of a board, and by the file of any other thing. */
async function begin(page, file) {
  if (file?.endsWith('board.toml')) await fillBoard(page, file);
  else if (file) await page.getByLabel(/^Or its file/).setInputFiles(file);
  await page.getByRole('button', {name: 'Begin, or go on'}).click();
  await page.locator('.set').waitFor();
}

async function countOf(page) {
  return Number(await page.locator('.known .count').innerText());
}

/** Presses Space and reads the answer to what was taken. */
async function take(page) {
  await page.keyboard.press('Space');
  const answer = page.locator('.answer');
  await answer.waitFor({state: 'detached'});
  await answer.waitFor({timeout: photograph_ms});
  return answer.innerText();
}

async function lay(rig, page, thing) {
  await rig.inject(`table ${thing}`);
  assert.match(await take(page), /taken/);
}

async function focal(page) {
  return parseFloat((await page.locator('[data-figure=focal_percent]').innerText()).replace(/^[^\d]+/, ''));
}

/** By the button that offers it, or the one that says that these photographs are enough. */
async function calculate(page, button) {
  await page.getByRole('button', {name: button}).click();
  await page.locator('.result').waitFor({timeout: calculation_ms});
  return page.locator('.result').innerText();
}

/** Seconds from each raw file of a set to the answer that the daemon logged next: both times are the daemon's. */
async function secondsToAnswers(rig, set) {
  const folder = path.join(rig.folder, 'sets', set);
  const written_ms = fs.readdirSync(folder, {recursive: true}).filter((name) => name.endsWith('.dng'))
    .map((name) => fs.statSync(path.join(folder, name)).mtimeMs);
  const {lines} = await rig.ask('log?limit=1000');
  const answered_ms = lines.filter(({event, session}) => event === 'scan_complete' && session === set).map(({time}) => Date.parse(time));
  return answered_ms.map((answered) => (answered - Math.max(...written_ms.filter((written) => written <= answered + 1))) / 1000);
}

/** The calibration that the page had made last is, but for the time of its making, that which `weft calibrate` makes. */
async function assertMadeAsByCommand(rig, verb) {
  const {jobs: [{wants: {output, input, from, trap}}]} = await rig.ask('jobs?limit=1');
  const byCommand = path.join(rig.folder, 'state', path.basename(output));
  await run(weft, ['calibrate', verb, input, '--from', from, ...(trap ? ['--trap', trap] : []), '-o', byCommand, '--quiet'], {cwd: rig.folder, env: rig.environment});
  const read = (folder) => fs.readdirSync(folder, {recursive: true}).sort()
    .filter((name) => fs.statSync(path.join(folder, name)).isFile())
    .map((name) => [name, fs.readFileSync(path.join(folder, name), 'latin1').replace(/^ *"measured": "[^"]*",$/m, '')]);
  const made = read(path.join(rig.folder, output));
  assert.ok(made.length > 2, `${made.length} files`);
  assert.deepEqual(made, read(byCommand));
}

test('photographs of a board are answered, counted and left out, and the set outlives a reload', async (t) => {
  const rig = await startRig({options: ['--bare']});
  try {
    const visitor = await visit(browser, rig);
    const page = await visitor.open(`${rig.address}/calibrate/all/first`);
    await begin(page, described(rig, 'board'));
    assert.match(await page.locator('.says').innerText(), /lay the board flat/i);

    await rig.inject('table board');
    await page.getByRole('button', {name: 'Look through the camera'}).click();
    await page.locator('.aim:has(.seen)').getByText(/[1-9]\d* corners of the board are seen/).waitFor();
    const atFirst = await focal(page);
    assert.match(await take(page), /taken, 45 corners/);
    await page.locator('.aim .wanted').waitFor({state: 'attached'});
    await page.locator('.aim .seen').waitFor({state: 'attached'});
    await picture(page, 'calibrate_board');

    await rig.inject('table board x=75 y=45');
    assert.match(await take(page), /not used: .+/);

    await rig.inject('table board tilt=40 azimuth=225 x=17 y=-14 height=57');
    assert.match(await take(page), /taken/);
    const afterTilt = await focal(page);
    assert.ok(afterTilt < atFirst, `${afterTilt} is not below ${atFirst}`);
    assert.deepEqual(await violations(page), []);
    const waits_s = await secondsToAnswers(rig, 'first-board');
    assert.equal(waits_s.length, 3);
    t.diagnostic(`answered ${waits_s.join(', ')} s after the photographs`);
    assert.ok(Math.max(...waits_s) < 2, `${waits_s}`);

    await page.reload();
    await page.locator('.set').waitFor();
    assert.equal(await countOf(page), 3);
    assert.equal(await focal(page), afterTilt);

    const [best] = await page.locator('.photographs li:has-text("taken") strong').allInnerTexts();
    await page.getByRole('button', {name: `Leave out ${best}`}).click();
    await page.getByRole('button', {name: `Take back ${best}`}).waitFor();
    assert.ok(await focal(page) > afterTilt, 'without it the lens is known less');
    await page.keyboard.press('Control+z');
    await page.getByRole('button', {name: `Leave out ${best}`}).waitFor();
    assert.equal(await focal(page), afterTilt);
    await visitor.leave();
  } finally {
    await rig.stop();
  }
});

test('a target is printed from the page, and the rig knows it from then on', async () => {
  const rig = await startRig({options: ['--bare']});
  try {
    const visitor = await visit(browser, rig);
    const page = await visitor.open(`${rig.address}/calibrate/all/first`);
    await page.getByRole('button', {name: 'Print a board'}).click();
    const link = page.getByRole('link', {name: /a ChArUco board of 10 x 7 squares/});
    assert.match(await link.getAttribute('href'), /calibrations\/targets\/board$/);
    assert.deepEqual(await violations(page), []);
    const pdf = fs.readFileSync(path.join(rig.folder, 'targets', 'board.pdf'), 'latin1');
    assert.match(pdf, /^%PDF-1\.4/);
    assert.match(fs.readFileSync(described(rig, 'board'), 'utf8'), /kind = "charuco"/);
    await begin(page);
    assert.match(await page.locator('.says').innerText(), /lay the board flat/i);
    await visitor.leave();
  } finally {
    await rig.stop();
  }
});

test('after each sheet the page says what the lights would be so far', async (t) => {
  const rig = await startRig();
  try {
    const visitor = await visit(browser, rig);
    const page = await visitor.open(`${rig.address}/calibrate/all/first?step=lights`);
    await begin(page, described(rig, 'sheet'));
    assert.equal(await page.getByRole('region', {name: 'So far'}).count(), 0, 'nothing before there is a sheet');
    const soFar = (sheets) => page.getByRole('region', {name: 'So far'}).getByText(sheets).waitFor({timeout: calculation_ms});
    await lay(rig, page, 'sheet');
    await soFar(/from 1 photographed sheet: positions to .* mm at worst/);
    await lay(rig, page, 'sheet tilt=20 azimuth=0');
    await lay(rig, page, 'sheet tilt=20 azimuth=180');
    await soFar(/from 3 photographed sheets: positions to .* mm at worst/);
    const waits_s = await secondsToAnswers(rig, 'first-sheet');
    assert.equal(waits_s.length, 3);
    t.diagnostic(`answered ${waits_s.join(', ')} s after the last photograph of a sheet`);
    assert.ok(Math.max(...waits_s) < 2, `${waits_s}`);
    assert.deepEqual(await violations(page), []);
    await picture(page, 'calibrate_so_far');
    await page.reload();
    await soFar(/from 3 photographed sheets/);
    const {jobs} = await rig.ask('jobs?limit=10');
    assert.deepEqual(jobs.map(({kind, wants}) => [kind, wants.output]), Array(3).fill(['calibrate_lights', undefined]), 'one a sheet');
    await page.getByRole('button', {name: 'What more poses buy'}).click();
    const more = page.getByRole('list', {name: 'More poses'}).getByRole('listitem');
    await more.nth(4).getByText(/^13 poses, 10 more/).waitFor({timeout: calculation_ms});
    assert.match(await more.first().innerText(), /^3 poses\s+[0-9.]+ mm, [0-9.]+°$/);
    await picture(page, 'calibrate_more_poses');
    await page.getByRole('button', {name: 'Enough: calculate with these'}).waitFor();
    await visitor.leave();
  } finally {
    await rig.stop();
  }
});

/** By the stage's place in the list: a walk does not come by it. */
async function photographTrap(rig, page) {
  await page.getByRole('button', {name: /^Veil of the lens/}).click();
  await begin(page);
  await rig.inject('table trap');
  await page.keyboard.press('Space');
  await page.getByText('The sensor is measured by them, too.').waitFor({timeout: photograph_ms});
}

test('a black trap is photographed where one chooses it, and a reload knows of it', async () => {
  const rig = await startRig();
  try {
    const visitor = await visit(browser, rig);
    const page = await visitor.open(`${rig.address}/calibrate/all/first?step=response`);
    await photographTrap(rig, page);
    await picture(page, 'calibrate_trap');
    await page.reload();
    await page.getByRole('button', {name: /^Veil of the lens.*done/}).waitFor();
    await visitor.leave();
  } finally {
    await rig.stop();
  }
});

/** The desk refuses a rig that moved, unless a person says why it is scanned all the same; returns the session. */
async function scanAllTheSame(rig, visitor, why) {
  const page = await visitor.open(`${rig.address}/desk`);
  await page.getByLabel('Fabric').fill('all the same');
  await page.getByRole('button', {name: 'Scan'}).and(page.locator(':enabled')).click();
  await page.getByRole('alert').filter({hasText: 'the rig has moved since it was calibrated'}).waitFor();
  await page.getByLabel('Reason').fill(why);
  await page.getByRole('button', {name: 'Scan'}).click();
  await page.getByRole('region', {name: 'Last scan'}).waitFor({timeout: photograph_ms});
  await page.close();
  const {sessions: [{name}]} = await rig.ask('sessions?query=same');
  return JSON.parse(fs.readFileSync(path.join(rig.folder, 'scans', `${name}.weft`, 'session.json'), 'utf8'));
}

test('a rig that was knocked is brought back: seen, fitted, proven, accepted', async () => {
  const rig = await startRig({options: ['--first', 'knock camera x=3 turn=0.4', '--first', 'knock led 3 x=6 z=-4']});
  try {
    const spoiled = await rig.scan('madder twill');
    const visitor = await visit(browser, rig);
    const page = await visitor.open(`${rig.address}/calibrate`);
    const place = page.locator('header .place');
    await place.getByText(/camera moved [23]\.\d mm and turned 0\.4.* LED 3 (moved|brighter) .*, costs 0\.\d\d degrees/).waitFor({timeout: calculation_ms});
    await page.getByRole('region', {name: 'State'}).getByText('calibrate again what moved').waitFor();
    await page.getByRole('button', {name: 'After a knock'}).click();
    // The rig knows its sheet: nothing is typed and no file is chosen.
    await begin(page);
    await lay(rig, page, 'sheet');
    await lay(rig, page, 'sheet tilt=20 azimuth=0');
    await lay(rig, page, 'sheet tilt=20 azimuth=90');
    const moved = await calculate(page, 'Calculate: what moved');
    assert.match(moved, /scanning on would cost/);
    assert.match(moved, /LED 3/);
    await picture(page, 'calibrate_moved');

    visitor.mayFail(/status of 422/);
    await rig.inject('table cloth');
    const {accepted_moved} = await scanAllTheSame(rig, visitor, 'only its colours count');
    assert.equal(accepted_moved.why, 'only its colours count');
    assert.ok(accepted_moved.degrees > 0.05, `${accepted_moved.degrees} degrees at stake`);

    await page.getByRole('button', {name: 'Go on: fitted again'}).click();
    await calculate(page, 'Calculate: fitted again');
    await page.getByRole('button', {name: 'Go on: proof'}).click();
    await begin(page);
    await page.locator('.aim .wanted').waitFor({state: 'attached'});
    await rig.inject('table sheet');
    await page.getByRole('button', {name: 'Look through the camera'}).click();
    await page.getByText('Not yet: the sheet lies turned as before: turn it by 90 degrees.').waitFor();
    await picture(page, 'calibrate_turn_it');
    assert.match(await take(page), /left out: the sheet lies turned as before: turn it by 90 degrees/);
    assert.equal(await page.getByText('No board is seen').count(), 0);
    await lay(rig, page, 'sheet turn=90');
    await lay(rig, page, 'sheet other=1');
    await lay(rig, page, 'sheet other=1 tilt=15 azimuth=210');
    assert.match(await calculate(page, 'Calculate: proof'), /Accepted: 3 sheets/);

    const change = page.locator('.acceptance');
    await change.getByText(/normals turn by .* degrees/).waitFor();
    await change.getByText(/albedo becomes/).waitFor();
    assert.deepEqual(await violations(page), []);
    await picture(page, 'calibrate_accept');
    await page.getByRole('button', {name: "Make it the rig's"}).click();
    await page.getByText(/The rig scans by calibrations\/.*-updated/).waitFor();
    assert.match(fs.readFileSync(path.join(rig.folder, 'rig.toml'), 'utf8'), /calibration = "calibrations\/.*-updated"/);

    await page.goto(`${rig.address}/calibrate`);
    await page.getByText(/passed, just now/).first().waitFor();
    await place.getByText('in place').waitFor();
    assert.deepEqual(await page.locator('.overview td, .overview th').filter({hasText: spoiled}).count(), 1, 'the scan after the knock is listed');
    await page.getByRole('button', {name: 'Solve 2 sessions again'}).click();
    await page.getByText('2 jobs queued').waitFor();
    const {jobs} = await rig.ask('jobs?limit=2');
    assert.ok(jobs.some((job) => job.of === spoiled));
    for (const job of jobs) assert.match(job.wants.calibration, /-updated$/);
    assert.deepEqual(await violationsByWidth(page, 'calibrate'), []);
    await visitor.leave();
  } finally {
    await rig.stop();
  }
});

test('which light to add is a table and a drawing, by cloth', async () => {
  const rig = await startRig();
  try {
    const visitor = await visit(browser, rig);
    const page = await visitor.open(`${rig.address}/calibrate`);
    const panel = page.getByRole('region', {name: 'Which light to add'});
    await panel.getByLabel('Cloth').selectOption('velvet');
    await panel.getByRole('button', {name: 'Say what each light tells'}).click();
    const table = panel.getByRole('table', {name: 'What each light tells'});
    await table.waitFor({timeout: calculation_ms});
    const {jobs: [{kind, wants, result}]} = await rig.ask('jobs?limit=1');
    assert.deepEqual([kind, wants], ['rig_plan', {cloth: 'velvet'}]);
    assert.equal(await table.locator('tbody tr').count(), result.rows.length);
    const row = table.getByRole('row', {name: 'crossed and parallel polarisers'});
    const polarisers = result.rows.find(({name}) => name === 'polarisers');
    assert.match(await row.innerText(), new RegExp(`${polarisers.sigma.normal_deg.toFixed(3)}°.*${polarisers.observable ? 'yes' : 'no'}.*\\+10`, 's'));
    await panel.getByText(result.verdict).waitFor();
    await page.waitForFunction(() => document.querySelector('.light-plan img')?.naturalWidth > 0);
    assert.deepEqual(await violationsByWidth(page, 'calibrate-light-plan'), []);

    await panel.getByLabel('Cloth').selectOption('');
    await panel.getByLabel('Roughness').fill('3');
    visitor.mayFail(/status of 400/);
    await panel.getByRole('button', {name: 'Say what each light tells'}).click();
    await panel.getByRole('alert').filter({hasText: 'from 0.02 to 1'}).waitFor();
    await visitor.leave();
  } finally {
    await rig.stop();
  }
});

const boards = [
  'board', 'board tilt=40 azimuth=225 x=17 y=-14 height=57', 'board tilt=40 azimuth=0 x=20 y=11 height=57',
  'board tilt=40 azimuth=180 x=-20 y=11 height=57', 'board tilt=40 azimuth=45 x=-18 y=-14 height=57',
  'board tilt=15 azimuth=135 x=-25 y=-19 height=57', 'board x=-35 y=21',
];
const sheets = ['sheet', ...[0, 180, 90, 270].map((azimuth) => `sheet tilt=20 azimuth=${azimuth}`)];
const proofs = ['sheet turn=90', 'sheet other=1', 'sheet other=1 tilt=15 azimuth=210'];

test('a bare rig is calibrated with nothing but the page', {skip: !isSoak && 'it takes minutes: WEFT_SOAK=1 runs it'}, async () => {
  const rig = await startRig({options: ['--bare']});
  const goOn = (page, stage) => page.getByRole('button', {name: `Go on: ${stage}`}).click();
  try {
    const visitor = await visit(browser, rig);
    const page = await visitor.open(`${rig.address}/calibrate/all/first`);
    await begin(page, described(rig, 'board'));
    for (const board of boards) await lay(rig, page, board);
    await page.getByText(/Arrows: seen less predicted/).waitFor();
    await picture(page, 'calibrate_arrows');
    await calculate(page, /^(Calculate|Enough)/);
    await assertMadeAsByCommand(rig, 'camera');

    await photographTrap(rig, page);
    await goOn(page, 'sensor');
    await begin(page);
    await lay(rig, page, 'sheet');
    await lay(rig, page, 'empty');
    assert.match(await calculate(page, 'Calculate: sensor'), /a veil of/);
    await assertMadeAsByCommand(rig, 'response');

    await goOn(page, 'lights');
    await begin(page, described(rig, 'sheet'));
    for (const sheet of sheets) await lay(rig, page, sheet);
    await calculate(page, 'Calculate: lights');
    await assertMadeAsByCommand(rig, 'lights');

    await goOn(page, 'colour');
    await begin(page, described(rig, 'chart'));
    await lay(rig, page, 'chart');
    await page.getByText('The thin line is where it lay in the last photograph.').waitFor();
    await page.locator('.aim .found').waitFor({state: 'attached'});
    await picture(page, 'calibrate_chart');
    await calculate(page, 'Calculate: colour');
    await assertMadeAsByCommand(rig, 'color');

    await goOn(page, 'proof');
    await begin(page);
    for (const sheet of proofs) await lay(rig, page, sheet);
    assert.match(await calculate(page, 'Calculate: proof'), /Accepted: 3 sheets/);
    await page.getByRole('button', {name: "Make it the rig's"}).click();
    await page.getByText('The rig scans by calibrations/first-color').waitFor();
    await page.goto(`${rig.address}/calibrate`);
    await page.getByText(/passed, just now/).first().waitFor();
    await place.getByText('in place').waitFor();
    await picture(page, 'calibrate_whole');
    await visitor.leave();
  } finally {
    await rig.stop();
  }
});
