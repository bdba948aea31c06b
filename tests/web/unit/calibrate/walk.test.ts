// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {
  currentStage, findingsIn, freeName, fromOf, isUnharmed, jobOf, madeBy, notesBeside, posesIn, requestOf, stagesOf, standingOf, trialsOf, walkOfSet, walksIn,
  type CheckResult, type Known, type Listed, type Walk, type Walks, type WalkStage,
} from '../../../../app/web/src/screens/calibrate/walk';
import type {Job} from '../../../../app/web/src/screens/jobs/queue';
import type {PhotographSet} from '../../../../app/web/src/screens/calibrate/photograph_set';

const all: Walk = {kind: 'all', name: 'first'};
const refresh: Walk = {kind: 'refresh', name: 'knock'};

function listed(folder: string, changes: Partial<Listed> = {}): Listed {
  return {folder, id: folder, measured: '2026-11-20T10:00:00Z', parts: [], check: null, is_rigs: false, ...changes};
}

function check(folder: string, passed: boolean): CheckResult {
  return {folder, date: '2026-11-21T10:00:00Z', calibration: '', passed, found: ''};
}

/** One that is to write calibrations/NAME. */
function job(kind: string, name: string, state: Job['state']): Job {
  return {kind, wants: {output: `calibrations/${name}`}, state} as Job;
}

function sheets(...photographs: [name: string, used: boolean][]): PhotographSet {
  return {
    photographs: photographs.map(([name, used]) => ({name, used, left_out: false, why: '', facts: {}})),
    next: {name: 'sheet05', kind: 'scan', says: '', pose: null},
  } as Partial<PhotographSet> as PhotographSet;
}

function stageOf(result: string, part: WalkStage['part'], job: WalkStage['job'], changes: Partial<WalkStage> = {}): WalkStage {
  return {result, part, job, title: result, about: '', thing: null, is_optional: false, is_aside: false, is_photographed: false, ...changes};
}

/** As the daemon serves them. */
const walks: Walks = {
  all: [
    stageOf('camera', 'board', 'calibrate_camera', {thing: 'board'}),
    stageOf('trap', 'trap', 'calibrate_response', {is_optional: true, is_aside: true}),
    stageOf('response', 'response', 'calibrate_response'),
    stageOf('lights', 'sheet', 'calibrate_lights', {thing: 'sheet'}),
    stageOf('color', 'chart', 'calibrate_color', {thing: 'chart', is_optional: true}),
    stageOf('check', 'check', 'check', {thing: 'sheet'}),
  ],
  refresh: [
    stageOf('moved', 'moved', 'check', {thing: 'sheet'}),
    stageOf('updated', 'moved', 'calibrate_update', {thing: 'sheet', is_photographed: true}),
    stageOf('check', 'check', 'check', {thing: 'sheet'}),
  ],
};
const rigs = listed('calibration', {is_rigs: true});
const bare: Known = {calibrations: [rigs], checks: [], jobs: [], series: [], walks};

function stage(walk: Walk, result: string): WalkStage {
  const found = stagesOf(walk, bare).find((each) => each.result === result);
  if (!found) throw new Error(`there is no stage ${result}`);
  return found;
}

describe('a walk', () => {
  test('begins with the board by what the rig has', () => {
    expect(currentStage(all, bare)?.part).toBe('board');
    expect(requestOf(all, stage(all, 'camera'), bare)).toEqual({
      kind: 'calibrate_camera', input: 'sets/first-board', from: 'calibration', output: 'calibrations/first-camera',
    });
  });

  test('begins with nothing at a rig that has nothing', () => {
    const nothing: Known = {calibrations: [], checks: [], jobs: [], series: [], walks};
    expect(fromOf(all, stage(all, 'camera'), nothing)).toBeNull();
    expect(requestOf(all, stage(all, 'camera'), nothing)).not.toHaveProperty('from');
  });

  test('goes on by the result before', () => {
    const known = {...bare, calibrations: [rigs, listed('calibrations/first-camera'), listed('calibrations/first-response')]};
    expect(currentStage(all, known)?.part).toBe('sheet');
    expect(fromOf(all, stage(all, 'lights'), known)).toBe('calibrations/first-response');
    expect(fromOf(all, stage(all, 'response'), known)).toBe('calibrations/first-camera');
    expect(madeBy(all, known)).toBe('calibrations/first-response');
  });

  test('may leave the colour chart out', () => {
    const made = ['camera', 'response', 'lights'].map((part) => listed(`calibrations/first-${part}`));
    const known = {...bare, calibrations: made, checks: [check('calibrations/first-check', true)]};
    expect(currentStage(all, known)).toBeNull();
    expect(madeBy(all, known)).toBe('calibrations/first-lights');
  });

  test('comes by the black trap only where a person chose it, and then the sensor is measured by both', () => {
    const known = {...bare, calibrations: [rigs, listed('calibrations/first-camera')]};
    expect(currentStage(all, known)?.part).toBe('response');
    expect(standingOf(all, stage(all, 'trap'), known)).toBe('open');
    expect(requestOf(all, stage(all, 'response'), known)).not.toHaveProperty('trap');
    const trapped = {...known, series: ['first-trap']};
    expect(standingOf(all, stage(all, 'trap'), trapped)).toBe('done');
    expect(currentStage(all, trapped)?.part).toBe('response');
    expect(requestOf(all, stage(all, 'response'), trapped)).toMatchObject({
      kind: 'calibrate_response', input: 'sets/first-response', trap: 'sets/first-trap', from: 'calibrations/first-camera',
    });
  });

  test('takes no result of another walk for its own', () => {
    expect(currentStage({kind: 'all', name: 'second'}, {...bare, calibrations: [listed('calibrations/first-camera')]})?.part).toBe('board');
  });
});

describe('after a knock', () => {
  test('the same photographs tell what moved and are fitted', () => {
    expect(requestOf(refresh, stage(refresh, 'moved'), bare)).toEqual({
      kind: 'check', moved: 'sets/knock-moved', from: 'calibration', output: 'calibrations/knock-moved',
    });
    expect(requestOf(refresh, stage(refresh, 'updated'), bare)).toMatchObject({kind: 'calibrate_update', moved: 'sets/knock-moved'});
  });

  test('a rig that did not move needs nothing', () => {
    const known = {...bare, checks: [check('calibrations/knock-moved', true)]};
    expect(isUnharmed(refresh, known)).toBe(true);
    expect(isUnharmed(refresh, {...bare, checks: [check('calibrations/knock-moved', false)]})).toBe(false);
    expect(isUnharmed(all, known)).toBe(false);
  });
});

describe('how a stage stands', () => {
  const camera = stage(all, 'camera');

  test('is what its job does until there is a result', () => {
    const standing = (state: Job['state']) => standingOf(all, camera, {...bare, jobs: [job('calibrate_camera', 'first-camera', state)]});
    expect([standing('queued'), standing('running'), standing('failed'), standing('cancelled')]).toEqual(['working', 'working', 'failed', 'open']);
  });

  test('is told by a job that is done before anybody listed its result', () => {
    const standing = (exit_code: number) => {
      const done = {...job('check', 'first-check', 'done'), exit_code};
      return standingOf(all, stage(all, 'check'), {...bare, jobs: [done]});
    };
    expect([standing(0), standing(65)]).toEqual(['done', 'found']);
  });

  test('is done once its folder is there, whatever a job said', () => {
    const jobs = [job('calibrate_camera', 'first-camera', 'failed')];
    expect(standingOf(all, camera, {calibrations: [listed('calibrations/first-camera')], checks: [], jobs})).toBe('done');
  });

  test('tells a check that found something', () => {
    expect(standingOf(all, stage(all, 'check'), {...bare, checks: [check('calibrations/first-check', false)]})).toBe('found');
  });

  test('is of the newest job of its own folder', () => {
    const jobs = [job('check', 'other-check', 'running'), job('check', 'first-check', 'failed'), job('check', 'first-check', 'done')];
    expect(jobOf(all, stage(all, 'check'), {...bare, jobs})).toBe(jobs[1]);
  });
});

describe('a trial of the lights', () => {
  const lights = stage(all, 'lights');
  const known = {...bare, calibrations: [rigs, listed('calibrations/first-response')]};

  test('is of the sheets that are used, by the result before, and writes nothing', () => {
    const inputs = {input: 'sets/first-sheet', from: 'calibrations/first-response'};
    expect(trialsOf(all, lights, sheets(['sheet01', true], ['sheet02', false], ['sheet03', true]), known)).toEqual([
      {...inputs, kind: 'calibrate_lights', request_id: 'first-sheet.calibrate_lights.sheet01.sheet03'},
      {...inputs, kind: 'calibrate_lights_price', request_id: 'first-sheet.calibrate_lights_price.sheet01.sheet03'},
    ]);
  });

  test('is none before a sheet is used, nor once no more is wanted, nor of another stage', () => {
    expect(trialsOf(all, lights, sheets(['sheet01', false]), known)).toEqual([]);
    expect(trialsOf(all, lights, {...sheets(['sheet01', true]), next: null}, known)).toEqual([]);
    expect(trialsOf(all, stage(all, 'check'), sheets(['turned', true]), known)).toEqual([]);
  });

  test('of boards, tells what more would buy from the third on', () => {
    const camera = stage(all, 'camera');
    const boards = (count: number) => sheets(...Array.from({length: count}, (_, i): [string, boolean] => [`board0${i}`, true]));
    expect(trialsOf(all, camera, boards(2), known)).toEqual([]);
    expect(trialsOf(all, camera, boards(3), known).map(({kind}) => kind)).toEqual(['calibrate_camera_price']);
  });

  test('says what more poses cost and give', () => {
    const rows = [
      {poses: 6, more: 0, rig_s: 0, predicted_deg: 0.041, place_mm: 0.092, position_mm: null, chosen: false},
      {poses: 8, more: 2, rig_s: 40, predicted_deg: 0.031, place_mm: 0.07, position_mm: null, chosen: true},
    ];
    expect(posesIn({rows})).toEqual([
      {says: '6 poses', figures: '0.092 mm, 0.041°', isBest: false},
      {says: '8 poses, 2 more', figures: '0.070 mm, 0.031°, 40 s', isBest: true},
    ]);
  });

  test('leaves the stage as it was', () => {
    const trial = {...job('calibrate_lights', '', 'done'), of: 'sets/first-sheet', wants: {input: 'sets/first-sheet'}};
    expect(standingOf(all, lights, {...known, jobs: [trial]})).toBe('open');
  });
});

describe('the names of walks', () => {
  test('are found in what lies beside the rig file, the newest first', () => {
    const known: Known = {
      calibrations: [rigs, listed('calibrations/first-camera'), listed('calibrations/knock-updated', {measured: '2026-11-22T10:00:00Z'})],
      checks: [check('calibrations/first-check', true), check('calibrations/leaned-moved', true)],
      jobs: [],
      series: [],
      walks,
    };
    expect(walksIn(known)).toEqual([
      {kind: 'refresh', name: 'knock'}, {kind: 'refresh', name: 'leaned'}, {kind: 'all', name: 'first'},
    ]);
  });

  test('are in the name of the set that is worked on', () => {
    expect(walkOfSet({name: '2026-11-24-board', part: 'board'})).toEqual({kind: 'all', name: '2026-11-24'});
    expect(walkOfSet({name: 'knock-moved', part: 'moved'})).toEqual({kind: 'refresh', name: 'knock'});
    expect(walkOfSet({name: 'board', part: 'board'})).toBeNull();
  });

  test('are the day, with a number from the second on', () => {
    expect(freeName('2026-11-24', [])).toBe('2026-11-24');
    expect(freeName('2026-11-24', [{kind: 'all', name: '2026-11-24'}, {kind: 'refresh', name: '2026-11-24-2'}])).toBe('2026-11-24-3');
  });
});

test('what a step says twice is shown once', () => {
  const findings = findingsIn([{text: 'LED 3 has moved by 7 mm', remedy: 'run weft calibrate update'}]);
  expect(notesBeside(['LED 3 has moved by 7 mm. To do: run weft calibrate update.', 'one frame is dark'], findings)).toEqual(['one frame is dark']);
});
