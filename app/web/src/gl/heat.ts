// SPDX-License-Identifier: Apache-2.0
// The colours of scalars, as the daemon's pictures have them: lightness rises evenly from dark violet over green to
// light yellow. In OKLCh (Ottosson 2020) L goes from 0.25 to 0.92 and hue from 300 to 105 degrees.

export type Rgb = [number, number, number];

export const HEAT_STEPS = 256;

/** sRGB, 0 to 1, of a linear value. */
export function srgb(linear: number): number {
  const value = Math.min(Math.max(linear, 0), 1);
  return value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055;
}

/** The colour of a share from 0 to 1, in sRGB. */
export function heatColour(share: number): Rgb {
  const t = Math.min(Math.max(share, 0), 1);
  const lightness = 0.25 + 0.67 * t;
  const chroma = 0.086 + 0.1 * t ** 3;
  const hue = ((300 - 195 * t) * Math.PI) / 180;
  const a = chroma * Math.cos(hue);
  const b = chroma * Math.sin(hue);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
    srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
    srgb(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s),
  ];
}

/** A row of 256 texels, red, green, blue and 255. */
export function heatTexels(): Uint8Array {
  const texels = new Uint8Array(4 * HEAT_STEPS);
  for (let i = 0; i < HEAT_STEPS; ++i) {
    const colour = heatColour(i / (HEAT_STEPS - 1)).map((value) => Math.round(255 * value));
    texels.set([...colour, 255], 4 * i);
  }
  return texels;
}
