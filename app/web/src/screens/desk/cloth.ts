// SPDX-License-Identifier: Apache-2.0
// What is said of the next cloth, kept while other screens are looked at.
import {computed, effect, signal} from '@preact/signals';
import {answer, api, asApiError, type ApiError, type Schemas} from '../../api/client';
import {rig} from '../../state/rig';

export interface Cloth {
  fabric: string;
  /** A barcode, or any other name of the swatch. */
  id: string;
  tags: string;
  height_mm: string;
  /** Empty: metered for this cloth. */
  exposure_ms: string;
}

const nothing: Cloth = {fabric: '', id: '', tags: '', height_mm: '', exposure_ms: ''};
export const cloth = signal<Cloth>(nothing);

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

/** As POST scan takes it: what is not said is as the rig file has it. */
export function scanRequestOf({fabric, id, tags, height_mm, exposure_ms}: Cloth): Schemas['ScanRequest'] {
  const metadata = {...(id.trim() && {id: id.trim()}), ...(tagsOf(tags).length && {tags: tagsOf(tags)})};
  const exposure = numberOr(exposure_ms, null);
  const height = numberOr(height_mm, null);
  return {
    fabric: fabric.trim(),
    ...(Object.keys(metadata).length && {metadata}),
    ...(height !== null && {cloth_height_mm: height}),
    ...(exposure !== null && {exposure_us: exposure * 1000}),
  };
}

export interface Proposal {
  /** What a scan would be called, and whether it goes on with one that is there. */
  would: Schemas['Started'] | null;
  refused: ApiError | null;
}
export const proposal = signal<Proposal>({would: null, refused: null});

const patience_ms = 250;
const request = computed(() => JSON.stringify(scanRequestOf(cloth.value)));
const mayAsk = computed(() => rig.value?.can.includes('scan') === true && cloth.value.fabric.trim() !== '');

async function propose(text: string): Promise<void> {
  const body: Schemas['ScanRequest'] = {...JSON.parse(text), dry_run: true};
  const would = await answer(api.POST('/api/v1/scan', {body})).catch(asApiError);
  if (request.value !== text) return;
  proposal.value = would instanceof Error ? {would: null, refused: would} : {would, refused: null};
}

/** Asks the daemon, as words are typed, which session a scan would be; returns what ends that. */
export function followProposal(): () => void {
  let timer = 0;
  const stop = effect(() => {
    const text = request.value;
    clearTimeout(timer);
    proposal.value = {would: null, refused: null};
    if (mayAsk.value) timer = window.setTimeout(() => void propose(text), patience_ms);
  });
  return () => {
    clearTimeout(timer);
    stop();
  };
}
