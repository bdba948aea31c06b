// SPDX-License-Identifier: Apache-2.0
import {counted} from '../../ui/say';
import {Mark} from '../../ui/mark';
import {bytesOf, timeOf} from '../../ui/words';
import {setInWords, useSets} from '../viewer/sets';
import {addressOfViewer} from '../viewer/sight';

/** What was made of the solves of a session: sets of maps, and the way to more. */
export function MapSets({session, solve}: {session: string; solve: string}) {
  const sets = useSets(session).filter(({preview}) => !preview);
  return (
    <section class="panel" aria-labelledby="sets-title">
      <h2 id="sets-title">Maps</h2>
      <ul class="solves">
        {sets.map((set) => (
          <li key={set.id}>
            <a class="button" href={addressOfViewer({session, solve: set.id, isSet: true})}>Look at them</a>
            <a class="button" href={`/material/${session}/maps/${set.id}`}>As a material</a>
            <span><strong>{setInWords(set)}</strong> <span class="dim numbers">{set.width} × {set.height}, {timeOf(set.created)}, {bytesOf(set.bytes)}</span></span>
            {set.draft && <Mark verdict="warning">draft</Mark>}
            {set.stale.map((why) => <Mark key={why} verdict="warning">stale: {why}</Mark>)}
            {set.warnings.length > 0 && <Mark verdict="warning">{counted(set.warnings.length, 'warning')}</Mark>}
          </li>
        ))}
      </ul>
      <a href={`/viewer/${session}/${solve}?panel=finish`}>Finish them: flatten, straighten, tile, repair</a>
    </section>
  );
}
