// SPDX-License-Identifier: Apache-2.0
import {describe, expect, test} from 'vitest';
import {merged, queueOf, stateOf, wishOf, withEvent, type Job, type JobEvent} from '../../../../app/web/src/screens/jobs/queue';

function job(id: string, changes: Partial<Job> = {}): Job {
  return {
    id, kind: 'solve', of: 'satin', wants: {}, by: '', state: 'queued', held: false, place: null, phase: '', share: 0, left_s: null, asked: '', began: '', ended: '',
    seconds: 0, exit_code: null, notes: [], error: null, result: null, ...changes,
  };
}

function eventOf({notes, result, place, ...event}: Job): JobEvent {
  return event;
}

describe('the queue', () => {
  test('has what waits in the order of its turn and the newest end first', () => {
    const jobs = [job('5'), job('4'), job('3', {state: 'running'}), job('2', {state: 'done'}), job('1', {state: 'failed'})];
    const {running, waiting, ended} = queueOf(jobs);
    expect([running, waiting, ended].map((list) => list.map(({id}) => id))).toEqual([['3'], ['4', '5'], ['2', '1']]);
  });

  test('has first what was put first', () => {
    const jobs = [job('3', {place: 0}), job('2', {place: 2}), job('1', {place: 1})];
    expect(queueOf(jobs).waiting.map(({id}) => id)).toEqual(['3', '1', '2']);
  });

  test('keeps result and notes, which an event does not bring', () => {
    const known = job('1', {notes: ['read'], result: {id: 'abc'} as never});
    const [after] = withEvent([known], eventOf(job('1', {state: 'running', share: 0.5})));
    expect(after).toMatchObject({state: 'running', share: 0.5, notes: ['read'], result: {id: 'abc'}});
  });

  test('begins with a job that it did not know', () => {
    expect(withEvent([job('1')], eventOf(job('2'))).map(({id}) => id)).toEqual(['2', '1']);
  });

  test('takes the newer document of each job', () => {
    const both = merged([job('1'), job('2')], [job('2', {state: 'done'}), job('3')]);
    expect(both.map(({id, state}) => `${id} ${state}`)).toEqual(['3 queued', '2 done', '1 queued']);
  });
});

test('a job says which level it is of', () => {
  expect(wishOf(job('1', {wants: {session: 'satin', quality: 'robust', calibration: 'calibrations/knock-updated'}}))).toBe('robust, by calibrations/knock-updated');
  expect(wishOf(job('1', {wants: {within_s: 20}}))).toBe('within 20 s');
  expect(wishOf(job('1'))).toBe('');
});

describe('how a job is', () => {
  test('is said in words', () => {
    expect(stateOf(job('1', {state: 'running', phase: 'solve'}))).toBe('solve');
    expect(stateOf(job('1', {state: 'running', held: true}))).toMatch(/scan/);
    expect(stateOf(job('1', {state: 'done', exit_code: 65}))).toMatch(/findings/);
    expect(stateOf(job('1', {state: 'done', exit_code: 0}))).toBe('done');
  });
});
