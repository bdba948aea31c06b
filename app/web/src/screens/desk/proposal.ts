// SPDX-License-Identifier: Apache-2.0
// What the next scan would be called and what it would take, as the daemon says before it begins.
import {computed, effect, signal} from '@preact/signals';
import {answer, api, asApiError, type ApiError, type Schemas} from '../../api/client';
import {rig} from '../../state/rig';
import {bought, cloth, scanRequestOf, withShots} from './cloth';
import {chosenIn} from './exposure';
import {blade, bracket, repeats} from './preferences';

/** Shutter times that the camera has, rising; empty until it was asked. One list for as long as they are the same. */
const listed = computed(() => JSON.stringify(rig.value?.devices.camera.exposures_us ?? []));
export const times_us = computed(() => JSON.parse(listed.value) as number[]);
/** What the exposure that is typed comes to. */
export const chosen = computed(() => chosenIn(cloth.value.exposure_ms, times_us.value));

/** As the form and the rig file have it. */
export const asked = computed(() => scanRequestOf(cloth.value, {repeat: repeats.value, bracket: bracket.value, blade: blade.value}, times_us.value));
export const scanRequest = computed(() => (bought.value ? withShots(asked.value, bought.value) : asked.value));

export interface Proposal {
  /** Its name and its bill, and whether it goes on with one that is there. */
  would: Schemas['Started'] | null;
  refused: ApiError | null;
}
const none: Proposal = {would: null, refused: null};
export const proposal = signal<Proposal>(none);

const patience_ms = 250;
const mayAsk = computed(() => rig.value?.can.includes('scan') === true && scanRequest.value.fabric !== '');

async function propose(request: Schemas['ScanRequest']): Promise<void> {
  const body = {...request, dry_run: true};
  const would = await answer(api.POST('/api/v1/scan', {body})).catch(asApiError);
  if (scanRequest.value !== request || !mayAsk.value) return;
  proposal.value = would instanceof Error ? {would: null, refused: would} : {would, refused: null};
}

/** Asks the daemon, as words are typed, what a scan would be; returns what ends that. */
export function followProposal(): () => void {
  let timer = 0;
  const stop = effect(() => {
    const request = scanRequest.value;
    clearTimeout(timer);
    if (mayAsk.value) timer = window.setTimeout(() => void propose(request), patience_ms);
    else proposal.value = none;
  });
  return () => {
    clearTimeout(timer);
    stop();
  };
}
