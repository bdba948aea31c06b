// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {cornerOf, tilesIn} from '../../../../app/web/src/screens/desk/loupe';

test('a loupe stays within the photograph', () => {
  expect(cornerOf({x: 0, y: 1}, 256, 1536, 1024)).toEqual({x: 0, y: 768});
  expect(cornerOf({x: 0.5, y: 0.5}, 256, 1536, 1024)).toEqual({x: 640, y: 384});
  expect(cornerOf({x: 0.5, y: 0.5}, 256, 200, 100), 'a small photograph').toEqual({x: 0, y: 0});
});

test('it shows the tiles that it touches, where they belong', () => {
  expect(tilesIn({x: 640, y: 384}, 256, 1536, 1024)).toEqual([
    {name: '1_0', left: -128, top: -384},
    {name: '1_1', left: -128, top: 128},
  ]);
  expect(tilesIn({x: 256, y: 256}, 256, 1536, 1024).map(({name}) => name)).toEqual(['0_0']);
  expect(tilesIn({x: 0, y: 0}, 256, 200, 100).map(({name}) => name)).toEqual(['0_0']);
});
