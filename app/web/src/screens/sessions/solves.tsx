// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {asApiError, type ApiError} from '../../api/client';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Empty} from '../../ui/empty';
import {Mark} from '../../ui/mark';
import {counted} from '../../ui/say';
import {bytesOf, timeOf} from '../../ui/words';
import {change} from './edits';
import type {OneSession} from './one_session';

interface SolvesProps {
  one: OneSession;
  onChanged: () => void;
}

/** The solves of a session; one is the current, of which further maps are made. */
export function Solves({one, onChanged}: SolvesProps) {
  const [complaint, complain] = useState<ApiError | null>(null);
  const {session, said, solves, hasTruth} = one;
  const makeCurrent = (id: string) => {
    complain(null);
    change(session.name, {current_solve: id, revision: said?.revision})
      .then(onChanged, (error: unknown) => complain(asApiError(error)));
  };
  return (
    <section class="panel" aria-labelledby="solves-title">
      <h2 id="solves-title">Solves</h2>
      {solves.length === 0 && (
        <Empty says="It is not solved yet.">
          <a href={`/jobs?price=${session.name}`}>See what each level costs and gives</a>
        </Empty>
      )}
      <ul class="solves">
        {solves.map(({id, method, width, height, warnings, created, bytes, outdated}) => (
          <li key={id}>
            <a class="button" href={`/viewer/${session.name}/${id}`}>Look at it</a>
            <span><strong>{method}</strong> <span class="dim numbers">{width} × {height}, {timeOf(created)}, {bytesOf(bytes)}</span></span>
            {outdated !== '' && <Mark verdict="warning">stale: {outdated}</Mark>}
            {warnings.length > 0 && <Mark verdict="warning">{counted(warnings.length, 'warning')}</Mark>}
            {session.current_solve === id
              ? <Mark verdict="fine">current</Mark>
              : <Button kind="quiet" onClick={() => makeCurrent(id)}>Make it the current one</Button>}
          </li>
        ))}
        {hasTruth && (
          <li>
            <a class="button" href={`/viewer/${session.name}/truth`}>Look at it</a>
            <span><strong>truth</strong> <span class="dim">of the simulation</span></span>
          </li>
        )}
      </ul>
      {solves.length > 0 && <a href={`/jobs?price=${session.name}`}>Solve it at another level: what each costs and gives</a>}
      <Complaint error={complaint} />
    </section>
  );
}
