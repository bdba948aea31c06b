// SPDX-License-Identifier: Apache-2.0
// What each level would cost and give for one session, and a button to have it.
import './price.css';
import {useState} from 'preact/hooks';
import {asApiError, type ApiError, type Schemas} from '../../api/client';
import {clothOf} from '../../state/cloths';
import {formOf, type Quality} from '../../state/forms';
import {Button} from '../../ui/button';
import {ClothName} from '../../ui/cloth_name';
import {Complaint} from '../../ui/complaint';
import {Empty} from '../../ui/empty';
import {textIn} from '../../ui/fields';
import type {Wish} from '../../ui/request_schema';
import {degrees, degreesOn} from '../../ui/say';
import {More} from '../../ui/schema_form';
import {Share} from '../../ui/share';
import {Table} from '../../ui/table';
import {durationOf} from '../../ui/words';
import {Crops} from './crops';
import {jobs, queueJob} from './jobs';
import {drawable, levelsIn, worthwhile, type Level} from './ladder';
import {LadderPlot} from './ladder_plot';
import {hasEnded, type Job} from './queue';

/** What a level that was priced says. */
const saidHere = ['session', 'quality', 'method', 'within_s', 'to_deg'];

export function Price({session}: {session: string}) {
  const [complaint, complain] = useState<ApiError | null>(null);
  const [wish, setWish] = useState<Wish>({});
  const priced = jobs.value.find((job) => job.kind === 'price' && job.of === session && job.state !== 'cancelled');
  const levels = levelsIn(priced?.result);

  const queue = (request: Schemas['JobRequest']) => {
    complain(null);
    queueJob(request).catch((error: unknown) => complain(asApiError(error)));
  };
  const price = () => queue({kind: 'price', session});
  const solve = (quality: Quality) => queue({kind: 'solve', session, quality, ...wish});

  return (
    <section class="panel price" aria-labelledby="price-title">
      <div class="row">
        <h2 id="price-title">Accuracy against time of <a href={`/sessions/${session}`}><ClothName session={session} /></a></h2>
        {levels.length > 0 && <Button kind="quiet" onClick={price}>Measure again</Button>}
      </div>
      <Complaint error={complaint} />
      {priced && !hasEnded(priced) && <Share label="Price" share={priced.share} left_s={priced.left_s} />}
      {priced?.state === 'failed' && <Complaint error={errorOf(priced)} />}
      {levels.length === 0 && (!priced || hasEnded(priced)) && (
        <Empty says="A cut from the middle is solved at every level: seconds tell what each costs and gives.">
          <Button kind="main" onClick={price}>Measure the levels</Button>
        </Empty>
      )}
      <More of="a solve" schema={formOf('solve')} wish={wish} onWish={setWish} without={saidHere} />
      {priced && levels.length > 0 && <Levels job={priced} levels={levels} onSolve={solve} />}
    </section>
  );
}

interface LevelsProps {
  job: Job;
  levels: readonly Level[];
  onSolve: (quality: Quality) => void;
}

function Levels({job, levels, onSolve}: LevelsProps) {
  const recommended = textIn(job.result, 'recommended');
  return (
    <>
      {drawable(levels).length > 0 && <LadderPlot levels={drawable(levels)} worthwhile={worthwhile(levels)} onChoose={onSolve} />}
      <Crops job={job.id} levels={levels} onChoose={onSolve} />
      <Table caption={`Levels of ${clothOf(job.of)}`} heads={['Level', 'Time', 'Error on so much of the cloth', 'noise', 'model', 'calibration', 'Note', 'Solve']}
        rows={levels.map((level) => ({
          key: level.quality,
          cells: [
            level.quality,
            durationOf(level.seconds),
            degreesOn(level.predicted_deg, level.solved),
            degrees(level.parts_deg.noise),
            degrees(level.parts_deg.model),
            degrees(level.parts_deg.calibration),
            [level.quality === recommended && 'the one to buy', level.note].filter(Boolean).join('; '),
            <Button label={`Queue ${level.quality}`} onClick={() => onSolve(level.quality)}>Queue</Button>,
          ],
        }))} />
    </>
  );
}

/** What a job that failed says, as a complaint. */
export function errorOf(job: {readonly error?: unknown}): Pick<ApiError, 'what' | 'where' | 'why' | 'remedy'> {
  const said = (job.error ?? {}) as Partial<Record<'what' | 'where' | 'why' | 'remedy', string>>;
  return {what: said.what ?? 'The job failed.', where: said.where ?? '', why: said.why ?? '', remedy: said.remedy ?? ''};
}
