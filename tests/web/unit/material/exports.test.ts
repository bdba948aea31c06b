// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {addressOfExports, addressOfFile, filesOf, priceInWords, pricesOf, requestOf} from '../../../../app/web/src/screens/material/exports';

const document = {
  preset: 'unreal',
  seconds: 1.234,
  notes: ['the albedo is relative'],
  files: [
    {file: 'T_satin_N.png', bytes: 2_000_000, encoding: 'png, 8 bits', direction: 'directx', lost: {normal_deg: {mean: 0.1834, p95: 0.3, max: 0.4}}},
    {file: 'T_satin_BC.png', bytes: 1_400_000, encoding: 'png, 8 bits', lost: {albedo: {mean: 0.0012, psnr_db: 50}}},
  ],
  documents: [{file: 'satin.glb', kind: 'glb', bytes: 100_000, files: []}],
};

test('a file says how it is stored, where its green leads and what it loses', () => {
  expect(filesOf(document)).toEqual([
    {file: 'T_satin_N.png', bytes: 2_000_000, says: 'png, 8 bits, green down, normals lose 0.18°'},
    {file: 'T_satin_BC.png', bytes: 1_400_000, says: 'png, 8 bits, albedo 0.0012'},
    {file: 'satin.glb', bytes: 100_000, says: 'glb'},
  ]);
});

test('a price is that of all files of its preset, and formats are compared beside', () => {
  const rows = [
    {file: 'a.png', encoding: 'png, 8 bits', bytes: 2e6, seconds: 1, lost: {}, preset: 'unreal'},
    {file: 'b.png', encoding: 'png, 16 bits', bytes: 1.5e6, seconds: 0.234, lost: {normal_deg: {mean: 0.001}}, preset: 'unreal'},
    {file: 'normals', encoding: 'dds, bc5', bytes: 1e6, seconds: 1, lost: {normal_deg: {mean: 1.6}}},
  ];
  const prices = pricesOf({rows});
  expect(priceInWords(prices.get('unreal')!)).toBe('3.5 MB, 1.2 s');
  expect(prices.get('unreal')!.files.map(({file}) => file)).toEqual(['a.png', 'b.png']);
  expect(prices.get('')!.files).toEqual([{file: 'normals', bytes: 1e6, says: 'dds, bc5, normals lose 1.6°'}]);
  expect(pricesOf(null).size).toBe(0);
});

test('exports are asked of the session or of the build, and a folder in a name stands as a colon', () => {
  const maps = {of: 'satin', is: 'maps', id: '1c'} as const;
  expect(addressOfFile(maps, 'exr', 'masters/a b.exr')).toBe('/api/v1/sessions/satin/exports/exr/files/masters%3Aa%20b.exr');
  expect(addressOfExports({of: 'cloth:wool', is: 'builds', id: 'ab'})).toBe('/api/v1/materials/cloth%3Awool/builds/ab/exports');
  expect(requestOf('export', maps, ['glb'])).toEqual({kind: 'export', session: 'satin', set: '1c', presets: ['glb']});
  expect(requestOf('export', maps, ['glb'], true)).toEqual({kind: 'export', session: 'satin', set: '1c', presets: ['glb'], draft: true});
  expect(requestOf('export_price', {of: 'dusty', is: 'builds', id: 'ab'}, ['glb'])).toEqual({kind: 'export_price', material: 'dusty', set: 'ab', presets: ['glb']});
});
