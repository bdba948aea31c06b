// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {addressOfMaterial, FIRST, nameOf, placeOfMaterial, type MaterialSight, queryOf, sightOf} from '../../../../app/web/src/screens/material/material_sight';

function again(sight: MaterialSight): MaterialSight {
  const query = new URLSearchParams();
  for (const [name, word] of Object.entries(queryOf(sight))) if (word !== null) query.set(name, word);
  return sightOf(query);
}

test('what is seen stands in the address, and at first nothing does', () => {
  expect(Object.values(queryOf(FIRST)).every((word) => word === null)).toBe(true);
  const sight: MaterialSight = {
    shape: 'plane', repeat: 3, ball_mm: 150, lean_deg: 40, light: [0.6, 0, 0.8], exposure: -1.5, surroundings: 0, typed: {roughness: 0.4, sheen: 0.25}, panel: 'export',
  };
  expect(again(sight)).toEqual(sight);
});

test('what an address says wrongly is as at first', () => {
  expect(sightOf(new URLSearchParams('shape=cube&repeat=9&lean=500&light=0,0,-1&exposure=x&roughness=7&panel=none'))).toEqual({...FIRST, lean_deg: 75, typed: {roughness: 1}});
});

test('maps of a session and builds of a material have addresses of their own', () => {
  expect(nameOf(['satin', 'maps', '1c0f'])).toEqual({of: 'satin', is: 'maps', id: '1c0f'});
  for (const parts of [['satin'], ['satin', 'solves', '1c'], ['satin', 'maps', '1c', 'x'], ['', 'maps', '1c']]) expect(nameOf(parts)).toBe(null);
  expect(addressOfMaterial({of: 'dusty', is: 'builds', id: 'ab'})).toBe('/api/v1/materials/dusty/builds/ab');
  expect(placeOfMaterial({of: 'satin', is: 'maps', id: 'ab'}, 'export')).toBe('/material/satin/maps/ab?panel=export');
});
