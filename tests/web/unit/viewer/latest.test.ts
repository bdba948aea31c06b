// SPDX-License-Identifier: Apache-2.0
import {afterEach, beforeEach, expect, test, vi} from 'vitest';
import {Latest} from '../../../../app/web/src/screens/viewer/latest';

beforeEach(() => vi.useFakeTimers());
afterEach(() => vi.useRealTimers());

/** Answers each question with itself after `takes_ms`. */
function latestOf(takes_ms: number) {
  const asked: {question: number; at: number}[] = [];
  const taken: number[] = [];
  const complaints: unknown[] = [];
  const ask = (question: number) => {
    asked.push({question, at: performance.now()});
    return new Promise<number>((resolve, reject) => setTimeout(() => (question < 0 ? reject(new Error('no')) : resolve(question)), takes_ms));
  };
  const latest = new Latest(ask, (answer) => taken.push(answer), (error) => complaints.push(error), 60);
  return {latest, asked, taken, complaints};
}

test('of many questions at most one in 60 ms is asked, and the last one always', async () => {
  const {latest, asked, taken} = latestOf(5);
  for (let question = 0; question < 100; question++) {
    latest.want(question);
    await vi.advanceTimersByTimeAsync(2);
  }
  await vi.advanceTimersByTimeAsync(200);
  const gaps = asked.slice(1).map(({at}, i) => at - asked[i]!.at);
  expect(Math.min(...gaps)).toBeGreaterThanOrEqual(60);
  expect(taken.at(-1)).toBe(99);
  expect(asked.length).toBeLessThanOrEqual(5);
});

test('while an answer is on its way nothing else is asked', async () => {
  const {latest, asked, taken} = latestOf(500);
  [1, 2, 3].forEach((question) => latest.want(question));
  await vi.advanceTimersByTimeAsync(400);
  expect(asked.length).toBe(1);
  await vi.advanceTimersByTimeAsync(700);
  expect(taken).toEqual([1, 3]);
});

test('an error is told, and the next question is asked all the same', async () => {
  const {latest, taken, complaints} = latestOf(5);
  latest.want(-1);
  await vi.advanceTimersByTimeAsync(100);
  latest.want(4);
  await vi.advanceTimersByTimeAsync(100);
  expect(complaints.length).toBe(1);
  expect(taken).toEqual([4]);
});

test('what waits can be forgotten', async () => {
  const {latest, asked} = latestOf(5);
  latest.want(1);
  latest.want(2);
  latest.forget();
  await vi.advanceTimersByTimeAsync(300);
  expect(asked.length).toBe(1);
});
