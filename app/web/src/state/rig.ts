// SPDX-License-Identifier: Apache-2.0
// The last word of the daemon about its rig.
import {signal} from '@preact/signals';
import {answer, api, type Schemas} from '../api/client';
import {connection, onEvent} from '../api/events';

export {connection};

export const rig = signal<Schemas['Rig'] | null>(null);
/** What runs there. Another one than at first means that this page is of an older program. */
export const version = signal<Schemas['Version'] | null>(null);
export const isOutdated = signal(false);

/** The events of this page's life: how many told of the status, and the last. */
const told: {count: number; status: Schemas['Status'] | null} = {count: 0, status: null};

/** An event that comes while the answer is on its way is newer than it. */
export async function askRig(): Promise<void> {
  const before = told.count;
  const asked = await answer(api.GET('/api/v1/rig'));
  rig.value = told.count === before ? asked : {...asked, ...told.status};
}

async function askVersion(): Promise<void> {
  const said = await answer(api.GET('/api/v1/version'));
  if (version.value && said.weft !== version.value.weft) isOutdated.value = true;
  version.value ??= said;
}

/** The whole state, asked for anew. What fails is told by the connection. */
function askAgain(): void {
  askRig().catch(() => {});
  askVersion().catch(() => {});
}

/** First asks, so that who is not let in is known by the error; then follows the events. */
export async function followRig(): Promise<void> {
  await Promise.all([askRig(), askVersion()]);
  onEvent('gap', askAgain);
  onEvent('status', (status) => {
    told.count++;
    told.status = status;
    const ended = rig.value?.state !== 'idle' && status.state === 'idle';
    if (rig.value) rig.value = {...rig.value, ...status};
    if (ended) askAgain();
  });
}
