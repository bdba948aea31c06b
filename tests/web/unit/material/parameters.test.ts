// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {layersOf, parametersOf, shadedBy} from '../../../../app/web/src/screens/material/parameters';

const maps = {
  maps: [
    {name: 'normal', file: 'normal.exr', unit: '', source: 'measured', mean: 0},
    {name: 'albedo', file: 'albedo.exr', unit: '', source: 'measured', mean: 0.31},
    {name: 'height', file: 'height.exr', unit: 'mm', source: 'derived', mean: 0},
    {name: 'roughness', unit: '', source: 'assumed', constant: 0.8, why: 'typed: --cloth cotton'},
    {name: 'specular', file: 'specular.exr', unit: 'share', source: 'measured', mean: 0.05},
  ],
};

const brief = (document: unknown) => Object.fromEntries(parametersOf(document).map(({name, source, value, ends}) => [name, [source, value, ends !== null]]));

test('each parameter has its mark, and what is assumed can be tried otherwise', () => {
  expect(brief(maps)).toEqual({
    normal: ['measured', 0, false], albedo: ['measured', 0.31, false], height: ['derived', 0, false], roughness: ['assumed', 0.8, true],
    f0: ['measured', 0.05, false], sheen: ['assumed', 0, true], sheen_roughness: ['assumed', 0.5, true],
    occlusion: ['assumed', 1, false], opacity: ['assumed', 1, false],
  });
});

test('what a solve left is measured, though a maps.json does not list it', () => {
  const document = {maps: [{name: 'roughness', source: 'assumed', constant: 1}]};
  const of = parametersOf(document, [{name: 'normal'}, {name: 'albedo'}, {name: 'roughness'}, {name: 'sigma'}]);
  const found = Object.fromEntries(of.map(({name, source, isMap}) => [name, [source, isMap]]));
  expect([found['normal'], found['albedo'], found['roughness']]).toEqual([['measured', true], ['measured', true], ['assumed', false]]);
});

test('numbers of a built material stand beside its maps', () => {
  const built = {...maps, parameters: {sheen: {value: [0.1, 0.2, 0.3], source: 'assumed'}, metallic: {value: 1, source: 'assumed'}, sheen_roughness: 0.3}};
  const {sheen, metallic, sheen_roughness} = brief(built);
  expect([sheen![0], sheen![2], metallic, sheen_roughness![1]]).toEqual(['assumed', true, ['assumed', 1, false], 0.3]);
  expect(sheen![1]).toBeCloseTo(0.2, 12);
});

test('a map is shaded by its texture, a number by itself, and what is typed goes before both', () => {
  const layers = layersOf([{name: 'albedo'}, {name: 'normal'}, {name: 'specular'}, {name: 'curl'}]);
  expect(layers.map(({layer}) => layer)).toEqual(['normal', 'albedo', 'specular']);
  const look = shadedBy(parametersOf(maps), layers, {sheen: 0.5});
  expect(look.typed).toEqual([1, 0.8, 1, 0.04]);
  expect(look.mapped).toEqual([0, 0, 0, 1]);
  expect(look.typed_sheen).toEqual([0.5, 0.5, 0.5, 0.5]);
});

test('highlights have the colour of their map, of their number, or none', () => {
  const tint = {name: 'specular_tint', file: 'specular_tint.exr', unit: 'share', source: 'measured', mean: 0.7};
  const tinted = {maps: [...maps.maps, tint]};
  const layers = layersOf([{name: 'specular'}, {name: 'specular_tint'}]);
  expect(layers.map(({layer, target}) => [layer, target])).toEqual([['specular', 'scalars'], ['specular_tint', 'tints']]);
  expect(shadedBy(parametersOf(tinted), layers, {}).typed_tint).toBeNull();
  expect(brief(tinted)['specular_tint']).toEqual(['measured', 0.7, false]);
  const built = {...maps, parameters: {specular_tint: {value: [1, 0.8, 0.3], source: 'assumed'}}};
  expect(shadedBy(parametersOf(built), layersOf([]), {}).typed_tint).toEqual([1, 0.8, 0.3]);
  expect(shadedBy(parametersOf(maps), layersOf([]), {}).typed_tint).toEqual([1, 1, 1]);
});
