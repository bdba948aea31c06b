// SPDX-License-Identifier: Apache-2.0
// Lengths as people read them, and the bar that shows one.

export interface ScaleBar {
  /** Pixels of the canvas. */
  length: number;
  says: string;
}

/** The longest of 1, 2, 5, 10 ... that is at most `most`. */
export function roundBelow(most: number): number {
  const decade = 10 ** Math.floor(Math.log10(most) + 1e-9);
  const digit = [5, 2, 1].find((each) => each * decade <= most * (1 + 1e-9)) ?? 1;
  return digit * decade;
}

/** "2 mm", "50 µm", "3 cm" */
export function lengthInWords(mm: number): string {
  if (mm < 0.1) return `${Number((mm * 1000).toPrecision(3))} µm`;
  if (mm >= 100) return `${Number((mm / 10).toPrecision(3))} cm`;
  return `${Number(mm.toPrecision(3))} mm`;
}

/** A bar of at most `most` pixels of the canvas. Without millimetres it counts pixels of the map. */
export function scaleBar(mm_per_pixel: number | null, zoom: number, most: number): ScaleBar {
  const each = mm_per_pixel ?? 1;
  const length = roundBelow((most / zoom) * each);
  const says = mm_per_pixel === null ? `${length} px` : lengthInWords(length);
  return {length: (length / each) * zoom, says};
}

/** "4.213 mm ± 0.011 mm"; digits end where the standard deviation begins. */
export function measured(mm: number, sigma_mm: number | null): string {
  if (sigma_mm === null) return `${mm.toFixed(3)} mm, uncertainty not known`;
  const decimals = Math.min(6, Math.max(0, 1 - Math.floor(Math.log10(Math.max(sigma_mm, 1e-6)))));
  return `${mm.toFixed(decimals)} mm ± ${sigma_mm.toFixed(decimals)} mm`;
}

/** "1:1", "4:1", "1:2.5" */
export function zoomInWords(zoom: number): string {
  const short = (value: number) => String(Number(value.toPrecision(3)));
  return zoom >= 1 ? `${short(zoom)}:1` : `1:${short(1 / zoom)}`;
}
