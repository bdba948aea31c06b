// SPDX-License-Identifier: Apache-2.0
// Sessions that a move of the rig may have spoiled, to be solved again by the calibration that the rig has now.
import {useState} from 'preact/hooks';
import {asApiError, type ApiError} from '../../api/client';
import {Button} from '../../ui/button';
import {ClothName} from '../../ui/cloth_name';
import {Complaint} from '../../ui/complaint';
import {counted, degrees} from '../../ui/say';
import {Table} from '../../ui/table';
import {timeOf} from '../../ui/words';
import {planChosen} from '../batches/plan_chosen';
import {queueJob} from '../jobs/jobs';
import type {Affected} from './history';

interface AffectedSessionsProps {
  sessions: readonly Affected[];
  /** The rig's calibration. */
  calibration: string;
}

export function AffectedSessions({sessions, calibration}: AffectedSessionsProps) {
  const [chosen, choose] = useState<ReadonlySet<string>>(new Set(sessions.filter((each) => each.isConcerned).map((each) => each.session)));
  const [queued, setQueued] = useState(0);
  const [complaint, complain] = useState<ApiError | null>(null);
  const turn = (name: string) => {
    const names = new Set(chosen);
    if (!names.delete(name)) names.add(name);
    choose(names);
  };
  const solve = async () => {
    complain(null);
    try {
      for (const session of chosen) await queueJob({kind: 'solve', session, quality: 'standard', calibration});
      setQueued(chosen.size);
    } catch (error) {
      complain(asApiError(error));
    }
  };
  return (
    <section class="panel" aria-labelledby="affected-title">
      <h2 id="affected-title">Sessions that a move may have spoiled</h2>
      <Table caption="Affected sessions" heads={['Session', 'Taken', 'It shows', 'Mean error']}
        rows={sessions.map((each) => ({
          key: each.session,
          cells: [
            <label class="row">
              <input type="checkbox" checked={chosen.has(each.session)} onChange={() => turn(each.session)} />
              <a href={`/sessions/${each.session}`}><ClothName session={each.session} /></a>
            </label>,
            timeOf(each.time),
            each.says || 'nothing; by its date perhaps',
            each.mean_deg === null ? 'not known' : degrees(each.mean_deg),
          ],
        }))} />
      <div class="row">
        <Button kind="main" isDisabled={chosen.size === 0} onClick={() => void solve()}>
          Solve {counted(chosen.size, 'session')} again
        </Button>
        <Button isDisabled={chosen.size === 0} onClick={() => planChosen([...chosen], calibration)}>Plan a night...</Button>
        {queued > 0 && <span role="status"><a href="/jobs">{counted(queued, 'job')} queued</a></span>}
      </div>
      <Complaint error={complaint} />
    </section>
  );
}
