// SPDX-License-Identifier: Apache-2.0
import {useEffect, useState} from 'preact/hooks';
import {answer, api, asApiError, type ApiError} from '../../api/client';
import {onEvent} from '../../api/events';
import {go} from '../../state/address';
import {useKeys} from '../../state/keys';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Copy} from '../../ui/copy';
import {timeOf} from '../../ui/words';
import {ChainPanel} from './chain_panel';
import {Frames} from './frames';
import {LastWord} from './last_word';
import {MetadataForm} from './metadata_form';
import {askSession, type OneSession} from './one_session';
import {askTags, shelf} from './shelf';
import {Solves} from './solves';

/** Histograms of a session that nobody looked at yet are made meanwhile. */
const countingEvery_ms = 700;

export function SessionPage({name}: {name: string}) {
  const [one, setOne] = useState<OneSession | null>(null);
  const [complaint, complain] = useState<ApiError | null>(null);
  const look = () => {
    askSession(name).then(
      (found) => (setOne(found), complain(null)),
      (error: unknown) => (setOne(null), complain(asApiError(error))),
    );
    void askTags();
  };
  useEffect(look, [name]);
  useEffect(() => {
    if (!one || one.session.histograms_complete) return undefined;
    const timer = setTimeout(look, countingEvery_ms);
    return () => clearTimeout(timer);
  }, [one]);
  useEffect(() => onEvent('job', (job) => job.of === name && job.state === 'done' && look()), [name]);
  useKeys('sessions', [
    {key: '[', does: 'session before', run: () => goBeside(name, -1)},
    {key: ']', does: 'next session', run: () => goBeside(name, 1)},
  ]);
  return (
    <div class="page one-session">
      <div class="row head">
        <a href="/sessions">Library</a>
        <h1>{one?.session.fabric || name}</h1>
        <LastWord onStep={look} />
      </div>
      <Complaint error={complaint} />
      {one && <Facts one={one} />}
      {one && <ChainPanel session={one.session} />}
      {one && (
        <div class="columns">
          <div class="column">
            <Solves one={one} onChanged={look} />
            <section class="panel" aria-labelledby="frames-title">
              <h2 id="frames-title">Photographs</h2>
              <Frames session={one.session} onChanged={look} />
            </section>
          </div>
          {one.said && <MetadataForm key={`${name} ${one.said.revision}`} name={name} said={one.said} onChanged={look} />}
        </div>
      )}
    </div>
  );
}

function Facts({one: {session}}: {one: OneSession}) {
  return (
    <div class="row facts">
      <span class="dim">{session.name}</span>
      {session.frames[0]?.time && <span class="dim numbers">{timeOf(session.frames[0].time)}</span>}
      {session.calibration && <span class="dim">cloth {session.cloth_height_mm} mm high, calibration {session.calibration.slice(0, 12)}</span>}
      <Copy what="Copy its path" text={session.folder} />
      {session.resumable && <Finish name={session.name} />}
    </div>
  );
}

/** An unfinished scan goes on at the desk. */
function Finish({name}: {name: string}) {
  const finish = useAction(async () => {
    await answer(api.POST('/api/v1/scan', {body: {session: name}}));
    go('/desk');
  });
  return (
    <>
      <Button kind="main" isDisabled={finish.isBusy} onClick={() => void finish.run()}>Finish the scan</Button>
      <Complaint error={finish.complaint} />
    </>
  );
}

/** To the neighbour in the list that one came from. */
function goBeside(name: string, by: 1 | -1): void {
  const {sessions} = shelf.value;
  const at = sessions.findIndex((session) => session.name === name);
  const beside = at < 0 ? undefined : sessions[at + by];
  if (beside) go(`/sessions/${beside.name}`);
}
