// SPDX-License-Identifier: Apache-2.0
// The sets of maps that were made of a session's solves.
import {useState} from 'preact/hooks';
import {answer, api, type Schemas} from '../../api/client';
import {onEvent} from '../../api/events';
import {useLatest} from '../../ui/use_latest';
import {textOf} from './sight';

export type MapSet = Schemas['MapSetSummary'];

async function setsOf(session: string): Promise<readonly MapSet[]> {
  return (await answer(api.GET('/api/v1/sessions/{name}/maps', {params: {path: {name: session}}}))).sets;
}

/** The newest first, previews among them; asked again when maps of the session were made. */
export function useSets(session: string): readonly MapSet[] {
  const [sets, setSets] = useState<readonly MapSet[]>([]);
  useLatest((latest) => {
    const ask = () => latest(setsOf(session)).then(setSets, () => setSets([]));
    void ask();
    return onEvent('job', (job) => {
      if (job.of === session && job.state === 'done') void ask();
    });
  }, [session]);
  return sets;
}

/** "maps 1c0f22aa, standard, a tile" */
export function setInWords({id, level, is_tile, preview}: MapSet): string {
  return [`${preview ? 'preview' : 'maps'} ${id.slice(0, 8)}`, level, is_tile ? 'a tile' : ''].filter((word) => word !== '').join(', ');
}

export function optionOf(session: string, set: MapSet): {value: string; says: string} {
  return {value: textOf({session, solve: set.id, isSet: true}), says: setInWords(set)};
}
