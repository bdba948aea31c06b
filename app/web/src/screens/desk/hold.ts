// SPDX-License-Identifier: Apache-2.0
// Whether a scan can be held, or goes on.
import type {Schemas} from '../../api/client';

export type Hold = 'pause' | 'resume';

/** What can be done to a scan that runs or was stopped by a fault; null: neither. One that was cancelled stays so. */
export function holdOf({can, state, error}: Pick<Schemas['Status'], 'can' | 'state' | 'error'>): Hold | null {
  if (can.includes('pause')) return 'pause';
  return can.includes('resume') && (state === 'paused' || error !== null) ? 'resume' : null;
}
