// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {addressOfViewer, asWritten, FIRST_SIGHT, nameOf, queryOf, sightOf, solveNameOf, textOf, type Sight} from '../../../../app/web/src/screens/viewer/sight';

const all: Sight = {
  layer: 'sigma_noise',
  view: {x: 1234.56789, y: 0.5, zoom: 0.123456789},
  light: [0.6, 0, 0.8],
  exposure: -1.5,
  range: [0, 0.3],
  bits: ['SHADOWED', 'SPECULAR'],
  other: {session: 'satin-3', solve: 'truth'},
  divider: 0.25,
  repeat: 3,
  seam: false,
  pixel: {x: 7, y: 8},
  line: [{x: 1.25, y: 2}, {x: 30, y: 40.5}],
  box: {x: 1, y: 2, width: 30, height: 40},
  panel: 'measure',
};

test('an address says all of a sight, and says nothing at first sight', () => {
  const written = asWritten(all);
  expect(written.view!.x).toBeCloseTo(1234.56789, 4);
  expect(written.view!.zoom).toBeCloseTo(0.123456789, 8);
  expect({...written, view: null}).toEqual({...all, view: null});
  expect(Object.values(queryOf(FIRST_SIGHT)).every((word) => word === null)).toBe(true);
});

test('what was written once is written the same again', () => {
  const once = asWritten(all);
  expect(asWritten(once)).toEqual(once);
});

test('no bits at all are something else than those that the layer shows by itself', () => {
  expect(asWritten({...all, bits: []}).bits).toEqual([]);
  expect(asWritten({...all, bits: null}).bits).toBe(null);
});

test('what an address says wrongly is as at first sight', () => {
  const wrong = 'view=1,2&light=0,0,0&range=3,1&exposure=bright&divider=x&with=only-a-session&panel=secrets&pixel=1,two';
  expect(sightOf(new URLSearchParams(wrong))).toEqual(FIRST_SIGHT);
});

test('a set of maps has a word of its own before its id', () => {
  const set = {session: 'satin-3', solve: '1c0f', isSet: true} as const;
  expect(addressOfViewer(set)).toBe('/viewer/satin-3/maps/1c0f');
  expect(solveNameOf(textOf(set))).toEqual(set);
  expect(solveNameOf('satin-3/solves/1c0f')).toBeNull();
  expect(nameOf(['satin-3', 'd043ba17'])).toEqual({session: 'satin-3', solve: 'd043ba17'});
});

test('an address can be opened anywhere', () => {
  const name = {session: 'satin-3', solve: 'd043ba17'};
  expect(addressOfViewer(name)).toBe('/viewer/satin-3/d043ba17');
  const address = new URL(addressOfViewer(name, all), 'http://rig');
  expect(sightOf(address.searchParams)).toEqual(asWritten(all));
});
