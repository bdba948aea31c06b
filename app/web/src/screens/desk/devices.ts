// SPDX-License-Identifier: Apache-2.0
// Board and camera, held open for a person who looks: the light, the finder, test shots.
import {computed, effect, signal, untracked} from '@preact/signals';
import {answer, api, asApiError, fetched, type ApiError, type Schemas} from '../../api/client';
import {isDark} from '../../state/dark';
import {askRig, rig} from '../../state/rig';

/** What lights the table while somebody looks: one LED after another, one of them, or the room alone. */
export type Light = 'round' | 'room' | number;

export const looks = signal(false);
export const light = signal<Light>('round');
/** Why the picture does not come; null: it does. */
export const trouble = signal<ApiError | null>(null);
export const picture = signal<ImageBitmap | null>(null);
export const framing = signal<Framing | null>(null);

export type Framing = NonNullable<Awaited<ReturnType<typeof askFraming>>>;

const lightEvery_ms = 500;
const framingEvery_ms = 400;
const again_ms = 1000;

/** A while, or until it is stopped. */
function pause(ms: number, stop: AbortSignal): Promise<void> {
  return new Promise((resolve) => {
    const timer = setTimeout(resolve, ms);
    stop.addEventListener('abort', () => {
      clearTimeout(timer);
      resolve();
    }, {once: true});
  });
}

function askFraming(after: number) {
  return answer(api.GET('/api/v1/rig/live/framing', {params: {query: {after}}}));
}

export async function openDevices(): Promise<void> {
  await answer(api.POST('/api/v1/rig/devices', {body: {open: true}}));
}

export async function closeDevices(): Promise<void> {
  looks.value = false;
  await answer(api.POST('/api/v1/rig/devices', {body: {open: false}}));
}

/** The light is on for as long as it is asked for again: whoever closes the page leaves the table dark. */
async function lightOnce(): Promise<void> {
  if (light.value === 'room') return;
  const body = light.value === 'round' ? {round: true} : {leds: [light.value]};
  await answer(api.POST('/api/v1/rig/light', {body}));
}

async function takeFrame(after: number, stop: AbortSignal): Promise<number> {
  const response = await fetched(`/api/v1/rig/live/frame?after=${after}`, stop);
  const next = await createImageBitmap(await response.blob());
  picture.value?.close();
  picture.value = next;
  trouble.value = null;
  return Number(response.headers.get('X-Weft-Frame'));
}

/** Does something again and again, one at a time, until it is stopped; what fails is tried again after a moment. */
async function repeat(stop: AbortSignal, every_ms: number, act: () => Promise<void>): Promise<void> {
  while (!stop.aborted) {
    const failed = await act().then(() => null, asApiError);
    if (stop.aborted) return;
    if (failed) trouble.value = failed;
    await pause(failed ? again_ms : every_ms, stop);
  }
}

function look(stop: AbortSignal): Promise<void>[] {
  let frame = 0;
  return [
    repeat(stop, 0, async () => {
      frame = await takeFrame(frame, stop);
    }),
    repeat(stop, framingEvery_ms, async () => {
      if (picture.value) framing.value = await askFraming(frame);
    }),
    repeat(stop, lightEvery_ms, lightOnce),
  ];
}

const isVisible = signal(!document.hidden);
document.addEventListener('visibilitychange', () => {
  isVisible.value = !document.hidden;
});

/** Whether anybody can look at this page: its tab is in front, and it is not black for a photograph. */
const isSeen = computed(() => isVisible.value && !isDark.value);

/** Others want the devices: nothing more is asked of them. */
const isHeld = signal(false);
let atWork: Promise<void>[] = [];

const finder = computed<'off' | 'opening' | 'on'>(() => {
  const can = rig.value?.can ?? [];
  if (!looks.value || !isSeen.value || isHeld.value) return 'off';
  return can.includes('light') ? 'on' : can.includes('devices') ? 'opening' : 'off';
});

function forgetPicture(): void {
  picture.value?.close();
  picture.value = null;
  framing.value = null;
  trouble.value = null;
}

/** Looks while somebody wants to and can see it; nothing is asked for a hidden or a dark page. */
export function followFinder(): () => void {
  return effect(() => {
    if (finder.value === 'off') return undefined;
    const stop = new AbortController();
    const isOn = finder.value === 'on';
    atWork = untracked(() => (isOn ? look(stop.signal) : [repeat(stop.signal, again_ms, openDevices)]));
    return () => {
      stop.abort();
      untracked(forgetPicture);
    };
  });
}

/** Asks for what needs the devices to itself, and knows how the rig is before anybody looks again. */
export async function withDevicesFree<T>(act: () => Promise<T>): Promise<T> {
  isHeld.value = true;
  try {
    await Promise.all(atWork);
    return await act();
  } finally {
    await askRig().catch(() => {});
    isHeld.value = false;
  }
}

/** The test shots of late, the newest last. */
export const shots = signal<readonly Schemas['TestShot'][]>([]);
const keptShots = 8;

export function takeShot(shot: Schemas['TestShot']): void {
  shots.value = [...shots.value.filter(({id}) => id !== shot.id), shot].slice(-keptShots);
}

export async function shootTest(led: number, exposure_us: number): Promise<void> {
  await openDevices();
  await answer(api.POST('/api/v1/rig/test-shot', {body: {led, exposure_us}}));
}
