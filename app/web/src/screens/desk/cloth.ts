// SPDX-License-Identifier: Apache-2.0
// What is said of the next cloth, kept while other screens are looked at.
import {signal} from '@preact/signals';
import type {Schemas} from '../../api/client';
import {chosenIn} from './exposure';

export interface Cloth {
  fabric: string;
  /** A barcode, or any other name of the swatch. */
  id: string;
  tags: string;
  height_mm: string;
  /** As it is typed. Empty: metered for this cloth. */
  exposure_ms: string;
}

const nothing: Cloth = {fabric: '', id: '', tags: '', height_mm: '', exposure_ms: ''};
export const cloth = signal<Cloth>(nothing);

type Shots = Schemas['ScanPrices']['rows'][number];
/** Other shots that a person took, of this cloth as of the next; null: as the rig says. */
export const bought = signal<Shots | null>(null);

export function say(change: Partial<Cloth>): void {
  cloth.value = {...cloth.value, ...change};
}

/** Height and exposure stay: the next swatch of a pile mostly has the same. */
export function forgetCloth(): void {
  cloth.value = {...cloth.value, fabric: '', id: '', tags: ''};
}

function numberOr<T>(text: string, absent: T): number | T {
  const number = Number(text.replace(',', '.'));
  return text.trim() === '' || Number.isNaN(number) ? absent : number;
}

export function tagsOf(text: string): string[] {
  return text.split(',').map((tag) => tag.trim()).filter((tag) => tag !== '');
}

/** Photographs beside each LED and the dark, of one cloth as of the next. */
export interface MoreShots {
  /** The first LED and the dark once more. */
  repeat: boolean;
  /** Each LED once more at so many times the exposure; empty: not. */
  bracket: string;
  /** This LED once more with a blade above the cloth; empty: none. */
  blade?: string;
}

/** As POST scan takes it: what is not said is as the rig file has it. `times_us`: those that the camera has. */
export function scanRequestOf({fabric, id, tags, height_mm, exposure_ms}: Cloth, {repeat, bracket, blade = ''}: MoreShots, times_us: readonly number[] = []): Schemas['ScanRequest'] {
  const metadata = {...(id.trim() && {id: id.trim()}), ...(tagsOf(tags).length && {tags: tagsOf(tags)})};
  const {exposure_us} = chosenIn(exposure_ms, times_us);
  const height = numberOr(height_mm, null);
  const share = numberOr(bracket, null);
  const shadow = numberOr(blade, null);
  return {
    fabric: fabric.trim(),
    repeat,
    ...(Object.keys(metadata).length && {metadata}),
    ...(height !== null && {cloth_height_mm: height}),
    ...(exposure_us !== null && {exposure_us}),
    ...(share !== null && {bracket: share}),
    ...(shadow !== null && {blade: shadow}),
  };
}

/** The shots of a price, in the place of those that the request asks for. */
export function withShots(request: Schemas['ScanRequest'], {leds, repeat, bracket, polariser}: Pick<Shots, 'leds' | 'repeat' | 'bracket' | 'polariser'>): Schemas['ScanRequest'] {
  return {...request, leds, repeat, bracket: bracket ?? undefined, ...(polariser.length > 0 && {polariser})} as Schemas['ScanRequest'];
}
