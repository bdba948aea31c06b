// SPDX-License-Identifier: Apache-2.0
import {useEffect, useState} from 'preact/hooks';
import {answer, api, type ApiError, asApiError, type Schemas} from '../../api/client';
import {Complaint} from '../../ui/complaint';
import {Empty} from '../../ui/empty';
import {addressOfViewer} from './sight';

type Summary = Schemas['Summary'];

const MOST = 100;

/** Nothing is chosen: the newest sessions that were solved. */
export function NoSession() {
  const [sessions, setSessions] = useState<Summary[] | null>(null);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  useEffect(() => {
    answer(api.GET('/api/v1/sessions', {params: {query: {limit: MOST}}})).then(
      (page) => setSessions(page.sessions.filter(({current_solve}) => current_solve !== '')),
      (error: unknown) => setComplaint(asApiError(error)),
    );
  }, []);
  return (
    <section class="page">
      <h1>Viewer</h1>
      <Complaint error={complaint} />
      {sessions?.length === 0 && (
        <Empty says="No session is solved yet.">
          <p><a href="/tour">Ways to begin</a></p>
        </Empty>
      )}
      <ul class="choose-session">
        {sessions?.map(({name, fabric, current_solve, thumbnail}) => (
          <li key={name}>
            <a href={addressOfViewer({session: name, solve: current_solve})}>
              <img alt="" width={192} height={192} loading="lazy" src={thumbnail ?? ''} />
              <span>{fabric || name}</span>
              <span class="dim">{name}</span>
            </a>
          </li>
        ))}
      </ul>
    </section>
  );
}
