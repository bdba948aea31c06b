// SPDX-License-Identifier: Apache-2.0
import {expect, test} from 'vitest';
import {ggxShares, sheen, sheenShare, shareTexels, TABLE_SIDE} from '../../../../app/web/src/gl/lobes';

/** The hemisphere in equal steps of cosine and azimuth, by another way than the table's own. */
function integral(of: (light: [number, number, number]) => number, steps = 400): number {
  let sum = 0;
  for (let i = 0; i < steps; ++i) {
    const z = (i + 0.5) / steps;
    const r = Math.sqrt(1 - z * z);
    for (let j = 0; j < steps; ++j) {
      const turn = (2 * Math.PI * (j + 0.5)) / steps;
      sum += of([r * Math.cos(turn), r * Math.sin(turn), z]) * z;
    }
  }
  return (2 * Math.PI * sum) / steps ** 2;
}

/** GGX with Smith's shadowing, as Walter et al. (2007) and Heitz (2014) write them: D and a G2 of lambdas. */
function ggx(v: readonly number[], l: readonly number[], alpha: number): {lobe: number; seen: number} {
  const h = v.map((each, i) => each + l[i]!);
  const length = Math.hypot(...h);
  const z = h[2]! / length;
  const tangent = (1 - z * z) / (z * z);
  const density = alpha ** 2 / (Math.PI * z ** 4 * (alpha ** 2 + tangent) ** 2);
  const lambda = (cosine: number) => (Math.sqrt(1 + alpha ** 2 * (1 / cosine ** 2 - 1)) - 1) / 2;
  const shadowing = 1 / (1 + lambda(v[2]!) + lambda(l[2]!));
  const seen = v.reduce((sum, each, i) => sum + (each * h[i]!) / length, 0);
  return {lobe: (density * shadowing) / (4 * v[2]! * l[2]!), seen};
}

test.each([[0.3, 0.7], [0.8, 0.7], [0.5, 1], [0.9, 0.5]])('what GGX sends back at cosine %d and roughness %d is its integral', (cosine, roughness) => {
  const v = [Math.sqrt(1 - cosine ** 2), 0, cosine];
  const white = integral((l) => ggx(v, l, roughness ** 2).lobe);
  const edge = integral((l) => {
    const {lobe, seen} = ggx(v, l, roughness ** 2);
    return lobe * (1 - seen) ** 5;
  });
  const {a, b} = ggxShares(cosine, roughness);
  expect(a + b, `${a + b} of ${white}`).toBeCloseTo(white, 2);
  expect(b, `${b} of ${edge}`).toBeCloseTo(edge, 2);
});

test('a mirror sends back everything, a rough one never more', () => {
  const mirror = ggxShares(0.5, 0.05);
  expect(mirror.a + mirror.b).toBeCloseTo(1, 2);
  for (let roughness = 0.1; roughness <= 1; roughness += 0.1) {
    for (let cosine = 0.05; cosine < 1; cosine += 0.1) {
      const {a, b} = ggxShares(cosine, roughness);
      expect(a + b).toBeLessThan(1.005);
    }
  }
});

test('sheen is the same with lamp and eye exchanged, and its share is its integral', () => {
  expect(sheen(0.3, 0.8, 0.6, 0.4)).toBe(sheen(0.8, 0.3, 0.6, 0.4));
  const v = [Math.sqrt(1 - 0.4 ** 2), 0, 0.4];
  const share = integral((l) => {
    const half = (v[2]! + l[2]) / Math.hypot(v[0]! + l[0], l[1], v[2]! + l[2]);
    return sheen(l[2], 0.4, half, 0.5);
  });
  expect(sheenShare(0.4, 0.5), `${sheenShare(0.4, 0.5)} of ${share}`).toBeCloseTo(share, 2);
});

test('the table has those numbers in the middle of its texels', () => {
  const texels = shareTexels();
  expect(texels.length).toBe(4 * TABLE_SIDE ** 2);
  const [row, column] = [11, 4];
  const {a} = ggxShares((column + 0.5) / TABLE_SIDE, (row + 0.5) / TABLE_SIDE);
  expect(texels[4 * (row * TABLE_SIDE + column)]).toBe(Math.round(255 * a));
});
