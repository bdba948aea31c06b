// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {tileBytes} from '../../../../app/web/src/gl/formats';
import {heatColour, heatTexels, srgb} from '../../../../app/web/src/gl/heat';

test('bytes of a tile follow from its kind', () => {
  const size = {width: 512, height: 100};
  expect((['normal', 'color', 'scalar', 'flags'] as const).map((kind) => tileBytes(kind, size))).toEqual([204800, 307200, 102400, 51200]);
});

test('colours of a scale grow lighter from end to end', () => {
  const luminance = (share: number) => {
    const linear = heatColour(share).map((value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4));
    return 0.2126 * linear[0]! + 0.7152 * linear[1]! + 0.0722 * linear[2]!;
  };
  for (let share = 0; share < 1; share += 0.05) expect(luminance(share + 0.05)).toBeGreaterThan(luminance(share));
  expect(heatColour(-3)).toEqual(heatColour(0));
  expect(heatColour(7)).toEqual(heatColour(1));
});

test('the row of texels holds the same colours', () => {
  const texels = heatTexels();
  const first = heatColour(0).map((value) => Math.round(255 * value));
  expect([...texels.slice(0, 4)]).toEqual([...first, 255]);
  expect(texels.length).toBe(1024);
});

test('the transfer function of sRGB has its published values', () => {
  expect(srgb(0.0031308)).toBeCloseTo(0.04045, 5);
  expect(srgb(0.2140411)).toBeCloseTo(0.5, 5);
  expect(srgb(2)).toBeCloseTo(1, 12);
});
