// SPDX-License-Identifier: Apache-2.0
// One session: its frames, what is said of it, its solves.
import {answer, api, type Schemas} from '../../api/client';
import {saidOf, type Said} from './metadata';

export type SessionFrame = Schemas['Frame'];

export interface OneSession {
  session: Schemas['Session'];
  /** Null where it cannot be read. */
  said: Said | null;
  solves: readonly Schemas['SolveSummary'][];
  /** It was simulated: its truth can be looked at like a solve. */
  hasTruth: boolean;
}

export async function askSession(name: string): Promise<OneSession> {
  const params = {path: {name}};
  const [session, solved] = await Promise.all([
    answer(api.GET('/api/v1/sessions/{name}', {params})),
    answer(api.GET('/api/v1/sessions/{name}/solves', {params})),
  ]);
  return {session, said: saidOf(session), solves: solved.solves, hasTruth: solved.truth};
}

/** The share of the channel that has the most photosites at or above white; null: not counted yet. */
export function clippedShare(frame: SessionFrame): number | null {
  if (!frame.histogram) return null;
  const {red, green, blue} = frame.histogram;
  return Math.max(red.clipped, green.clipped, blue.clipped);
}

export function clippingVerdict(share: number): 'fine' | 'warning' | 'fault' {
  if (share < 0.001) return 'fine';
  return share < 0.01 ? 'warning' : 'fault';
}

/** The shots that no solve shall use, with this one among them or not. */
export function leftOut(shots: readonly number[], index: number, out: boolean): number[] {
  const others = shots.filter((shot) => shot !== index);
  return out ? [...others, index].sort((a, b) => a - b) : others;
}

/** The frames that stand: one that was taken again is left to its successor. */
export function standing(frames: readonly SessionFrame[]): SessionFrame[] {
  return frames.filter((frame) => frame.superseded_by === null);
}
