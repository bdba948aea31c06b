// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {addressesOf, addressOf, drawnOf, type Scene, sheetsOf, type Side} from '../../../../app/web/src/gl/scene';

const bits = ['SATURATED', 'SHADOWED', 'ZERO_DOF', 'DARK', 'ILL_CONDITIONED', 'NO_SOLUTION', 'SPECULAR', 'INVALID_READING'];
const pyramid = {size: {width: 1400, height: 900}, side: 512, levels: 5};
const side: Side = {maps: '/api/v1/sessions/s/solves/1', pyramid, mode: 'relit', layer: 'relit', other: null, gain: 1, bits: []};
const canvas = {width: 800, height: 600};

function sceneOf(zoom: number): Scene {
  const look = {light: [0, 0, 1] as [number, number, number], exposure: 0, range: [0, 1] as [number, number]};
  return {view: {x: 700, y: 450, zoom}, bits: {names: bits, colours: []}, sides: [side], divider: 1, look, repeat: 1, is_moving: false};
}

test('relit reads normals and albedo, a scalar itself alone', () => {
  expect(sheetsOf(side, bits).map(({layer}) => layer)).toEqual(['normal', 'albedo']);
  expect(sheetsOf({...side, mode: 'scalar', layer: 'sigma_noise'}, bits).map(({layer}) => layer)).toEqual(['sigma_noise']);
});

test('each bit is asked for by its name and has a channel of its own', () => {
  const sheets = sheetsOf({...side, mode: 'scalar', bits: ['SHADOWED', 'SPECULAR']}, bits).slice(1);
  expect(sheets.map(({query, target, channel}) => [query, target, channel])).toEqual([
    ['?bit=SHADOWED', 'flags_low', 1],
    ['?bit=SPECULAR', 'flags_high', 2],
  ]);
});

test('a difference names the other solve', () => {
  const [sheet] = sheetsOf({...side, mode: 'scalar', layer: 'difference', other: 's/truth'}, bits);
  expect(addressOf(sheet!, {level: 1, column: 2, row: 0})).toBe('/api/v1/sessions/s/solves/1/tiles/difference/1/2_0.raw?with=s%2Ftruth');
});

test('the whole map comes first, small and then as one tile, then all layers from the middle outwards', () => {
  const addresses = addressesOf(sheetsOf(side, bits), sceneOf(1), canvas).map((address) => address.replace(/.*tiles\//, ''));
  expect(addresses.slice(0, 6)).toEqual(['normal/4/0_0.raw', 'albedo/4/0_0.raw', 'normal/2/0_0.raw', 'albedo/2/0_0.raw', 'normal/0/1_0.raw', 'albedo/0/1_0.raw']);
  expect(new Set(addresses).size).toBe(addresses.length);
});

test('below each tile that is missing the finest coarser one is drawn, and once all are there no more', () => {
  const part = drawnOf(pyramid, sceneOf(1), canvas, ({level, column}) => level === 2 || column === 1);
  expect(part.map(({level}) => level)).toEqual([...part.map(({level}) => level)].sort((a, b) => b - a));
  expect(part[0]!.level).toBe(2);
  expect(part.filter(({level}) => level === 1).map(({column}) => column)).toEqual([1]);
  const all = drawnOf(pyramid, sceneOf(1), canvas, () => true);
  expect(new Set(all.map(({level}) => level))).toEqual(new Set([0]));
});
