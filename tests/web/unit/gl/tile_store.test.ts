// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {TileStore} from '../../../../app/web/src/gl/tile_store';

interface Request {
  address: string;
  signal: AbortSignal;
  give: (bytes: number) => void;
  fail: (error: Error) => void;
}

/** A store whose tiles are their sizes, given by hand. */
function storeOf(budget_bytes = 1000, at_once = 2) {
  const requests: Request[] = [];
  const freed: number[] = [];
  const load = (address: string, signal: AbortSignal) =>
    new Promise<number>((give, fail) => {
      requests.push({address, signal, give, fail});
      signal.addEventListener('abort', () => fail(new Error('aborted')));
    });
  let changes = 0;
  const store = new TileStore<number>({load, bytes: (tile) => tile, free: (tile) => freed.push(tile)}, () => changes++, {budget_bytes, at_once});
  return {store, requests, freed, changes: () => changes};
}

/** Lets promises that are settled be heard. */
const settled = () => new Promise<void>((done) => setImmediate(done));

test('a few are asked at once, the most wanted first', async () => {
  const {store, requests} = storeOf();
  store.want(['a', 'b', 'c']);
  expect(requests.map(({address}) => address)).toEqual(['a', 'b']);
  requests[0]!.give(1);
  await settled();
  expect(requests.map(({address}) => address)).toEqual(['a', 'b', 'c']);
});

test('what is no longer wanted is given up, and asked for again when it is', async () => {
  const {store, requests} = storeOf();
  store.want(['a', 'b']);
  store.want(['b', 'c']);
  expect(requests[0]!.signal.aborted).toBe(true);
  await settled();
  expect(requests.map(({address}) => address)).toEqual(['a', 'b', 'c']);
  store.want(['a']);
  await settled();
  expect(requests.at(-1)!.address).toBe('a');
  expect(store.failure).toBe(null);
});

test('it is complete once all that is wanted is there', async () => {
  const {store, requests, changes} = storeOf();
  store.want(['a', 'b']);
  requests[0]!.give(10);
  await settled();
  expect(store.isComplete).toBe(false);
  requests[1]!.give(10);
  await settled();
  expect(store.isComplete).toBe(true);
  expect(store.get('a')).toBe(10);
  expect(changes()).toBe(2);
});

test('beyond the budget the least recently used go, but nothing that is wanted', async () => {
  const {store, requests, freed} = storeOf(250, 4);
  store.want(['a', 'b']);
  requests[0]!.give(101);
  requests[1]!.give(102);
  await settled();
  store.get('a');
  store.want(['c']);
  requests[2]!.give(103);
  await settled();
  expect(freed).toEqual([102]);
  expect(store.get('b')).toBe(undefined);
  store.want(['a', 'c', 'd']);
  requests[3]!.give(104);
  await settled();
  expect(freed).toEqual([102]);
});

test('what could not be had is told, not asked for without end, and asked again on demand', async () => {
  const {store, requests} = storeOf();
  store.want(['a']);
  requests[0]!.fail(new Error('gone'));
  await settled();
  expect(store.failure).toEqual(new Error('gone'));
  store.want(['a']);
  expect(requests.length).toBe(1);
  store.retry();
  expect(requests.length).toBe(2);
});

test('closing frees everything', async () => {
  const {store, requests, freed} = storeOf();
  store.want(['a', 'b']);
  requests[0]!.give(7);
  await settled();
  store.close();
  expect(freed).toEqual([7]);
  expect(requests[1]!.signal.aborted).toBe(true);
});
