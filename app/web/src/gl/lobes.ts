// SPDX-License-Identifier: Apache-2.0
// What the lobes of a cloth send back of a sky that is equally bright, as a table of cosine to the eye and roughness
// (alpha is its square). Lobes as glTF has them: GGX (Walter et al. 2007) with Smith's shadowing by height, sheen by
// Estevez and Kulla (2017) with the visibility of Neubelt and Pettineo (2013).

export const TABLE_SIDE = 16;

const ggxSamples = 512;
const sheenSteps = 48;

/** Without Fresnel's share and with it alone: a surface of f0 sends back f0 * a + b. */
export function ggxShares(cosine: number, roughness: number): {a: number; b: number} {
  const squared = roughness ** 4;
  const sine = Math.sqrt(1 - cosine * cosine);
  let a = 0;
  let b = 0;
  for (let i = 0; i < ggxSamples; ++i) {
    const u = (i + 0.5) / ggxSamples;
    const turn = 2 * Math.PI * ((i * 0.6180339887498949) % 1);
    const h = Math.sqrt((1 - u) / (1 + (squared - 1) * u));
    const across = Math.sqrt(1 - h * h) * Math.cos(turn);
    const seen = sine * across + cosine * h;
    const lit = 2 * seen * h - cosine;
    if (seen <= 0 || lit <= 0) continue;
    const shadowing = 0.5 / (lit * Math.sqrt(cosine * cosine * (1 - squared) + squared) + cosine * Math.sqrt(lit * lit * (1 - squared) + squared));
    const weight = (4 * shadowing * lit * seen) / h / ggxSamples;
    const fresnel = (1 - seen) ** 5;
    a += (1 - fresnel) * weight;
    b += fresnel * weight;
  }
  return {a, b};
}

/** Sheen between two directions, cosines to the normal and of the angle between normal and half vector. */
export function sheen(lit: number, seen: number, half: number, roughness: number): number {
  const inverse = 1 / Math.max(roughness * roughness, 1e-3);
  const density = ((2 + inverse) * (1 - half * half) ** (inverse / 2)) / (2 * Math.PI);
  return density / (4 * (lit + seen - lit * seen));
}

export function sheenShare(cosine: number, roughness: number): number {
  const sine = Math.sqrt(1 - cosine * cosine);
  let sum = 0;
  for (let i = 0; i < sheenSteps; ++i) {
    const lit = (i + 0.5) / sheenSteps;
    const across = Math.sqrt(1 - lit * lit);
    for (let j = 0; j < sheenSteps; ++j) {
      const between = across * sine * Math.cos((Math.PI * (j + 0.5)) / sheenSteps) + lit * cosine;
      const half = Math.min((lit + cosine) / Math.sqrt(2 + 2 * between), 1);
      sum += sheen(lit, cosine, half, roughness) * lit;
    }
  }
  return Math.min((2 * Math.PI * sum) / sheenSteps ** 2, 1);
}

/** Texels of a, b and sheen: the cosine grows along rows, the roughness down them; a texel has the values of its middle. */
export function shareTexels(): Uint8Array {
  const texels = new Uint8Array(4 * TABLE_SIDE * TABLE_SIDE);
  for (let row = 0; row < TABLE_SIDE; ++row) {
    for (let column = 0; column < TABLE_SIDE; ++column) {
      const cosine = (column + 0.5) / TABLE_SIDE;
      const roughness = (row + 0.5) / TABLE_SIDE;
      const {a, b} = ggxShares(cosine, roughness);
      texels.set([a, b, sheenShare(cosine, roughness), 1].map((share) => Math.round(255 * Math.min(share, 1))), 4 * (row * TABLE_SIDE + column));
    }
  }
  return texels;
}
