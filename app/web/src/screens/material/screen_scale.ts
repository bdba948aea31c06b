// SPDX-License-Identifier: Apache-2.0
// How large this screen's pixels are. A browser says 96 an inch whatever the screen is; a card laid on it tells the truth,
// which this browser keeps by pixels of the screen, so that it holds when the page is zoomed.
import {signal} from '@preact/signals';

/** A bank card's sides (ISO/IEC 7810 ID-1). */
export const CARD_MM = [85.6, 53.98] as const;
export const BROWSER_PX_PER_MM = 96 / 25.4;
const key = 'weft.screen_px_per_mm';

function kept(): number | null {
  const number = Number(localStorage.getItem(key));
  return number > 0.5 && number < 50 ? number : null;
}

/** Pixels of the screen a millimetre; null: nobody held a card to it yet. */
export const measured = signal<number | null>(kept());

/** Pixels of the page a millimetre. */
export function pxPerMm(): number {
  return measured.value === null ? BROWSER_PX_PER_MM : measured.value / (devicePixelRatio || 1);
}

/** In pixels of the page; null: what the browser says. */
export function keep(px_per_mm: number | null): void {
  measured.value = px_per_mm === null ? null : px_per_mm * (devicePixelRatio || 1);
  if (measured.value === null) localStorage.removeItem(key);
  else localStorage.setItem(key, String(measured.value));
}
