// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {builtBy, movedBy, ownValues, requestOf, stackOf, valueInWords, wishesOf} from '../../../../app/web/src/screens/material/stack';

const values = [
  {key: 'name', value: 'dusty', from: '/m/dusty.toml'},
  {key: 'surface.roughness', value: [0.6], from: 'library:cloth/cotton'},
  {key: 'layer.dust.material', value: 'library:dirt/dust', from: '/m/dusty.toml'},
  {key: 'layer.dust.mask', value: {kind: 'cavity', radius_mm: 0.4}, from: '/m/dusty.toml'},
  {key: 'layer.dust.alpha', value: [0.5], from: '/m/child.toml'},
  {key: 'layer.stain.material', value: 'library:dirt/stain', from: '/m/dusty.toml'},
  {key: 'layer.stain.alpha', value: 0, from: '/m/dusty.toml'},
  {key: 'layer.stain.blend', value: 'detail', from: '/m/dusty.toml'},
];

test('layers stand as they lie, the top one first, each with its files', () => {
  const stack = stackOf({layers: ['dust', 'stain'], values});
  expect(stack.map(({name, material, alpha, mask, blend, from}) => ({name, material, alpha, mask, blend, from}))).toEqual([
    {name: 'stain', material: 'library:dirt/stain', alpha: 0, mask: 'everywhere', blend: 'detail', from: ['dusty.toml']},
    {name: 'dust', material: 'library:dirt/dust', alpha: 0.5, mask: 'cavity, radius 0.4 mm', blend: 'replace', from: ['dusty.toml', 'child.toml']},
  ]);
  expect(ownValues({values}).map(({key}) => key)).toEqual(['name', 'surface.roughness']);
});

test('values are read as words', () => {
  expect(valueInWords([0.1, 0.25, 1 / 3])).toBe('0.1 0.25 0.3333');
  expect(valueInWords({map: '/m/paint.png', scale: 2})).toBe('map paint.png, scale 2');
  expect(valueInWords({from: 'height', at_mm: 0.1, soft_mm: 0.05})).toBe('height, at 0.1 mm, soft 0.05 mm');
  expect(valueInWords({value: 0.5})).toBe('0.5');
  expect(valueInWords(true)).toBe('true');
});

test('a build is that of the material that was asked for', () => {
  expect(builtBy({built: 2, materials: [{name: 'dusty', id: '2b97'}]})).toBe('2b97');
  expect(builtBy(null)).toBe('');
});

test('layers that are moved, dimmed and turned off are asked for from the bottom to the top', () => {
  const stack = stackOf({layers: ['dust', 'stain'], values});
  const wishes = movedBy(wishesOf(stack), 0, 1);
  expect(wishes).toEqual([{name: 'dust', alpha: 0.5, isOn: true}, {name: 'stain', alpha: 0, isOn: false}]);
  expect(movedBy(wishes, 0, -1)).toEqual(wishes);
  const changed = wishes.map((wish) => (wish.name === 'dust' ? {...wish, isOn: false} : wish));
  expect(requestOf('clean', 'dusty', changed, stack)).toEqual({name: 'clean', inherits: 'dusty', layers: [{name: 'stain'}, {name: 'dust', alpha: 0}]});
});
