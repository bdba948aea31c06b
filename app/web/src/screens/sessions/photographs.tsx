// SPDX-License-Identifier: Apache-2.0
// Photographs that no rig took become sessions, by their light file or a ball among them.
import {useEffect, useState} from 'preact/hooks';
import {formOf} from '../../state/forms';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {fieldsOf, textIn, textsIn} from '../../ui/fields';
import type {Wish} from '../../ui/request_schema';
import {SchemaForm} from '../../ui/schema_form';
import {jobs, queueJob, useJobs} from '../jobs/jobs';
import {errorOf} from '../jobs/price';
import {JobLine} from '../material/job_line';
import {importedOf} from './imported';

const asked = ['folders', 'ball', 'ball_mm', 'mm_per_pixel', 'flip', 'transfer'];

export function Photographs({onMade}: {onMade: () => void}) {
  useJobs();
  const schema = formOf('import');
  const [wish, setWish] = useState<Wish>({});
  const [id, setId] = useState('');
  const bring = useAction(async () => setId((await queueJob({kind: 'import', folders: '', ...wish})).id));
  const job = jobs.value.find((each) => each.id === id);
  useEffect(() => {
    if (job?.result) onMade();
  }, [job?.result]);
  return (
    <details class="panel">
      <summary>Photographs of your own</summary>
      <SchemaForm schema={schema} wish={wish} onWish={setWish} without={schema.fields.map(({name}) => name).filter((name) => !asked.includes(name))} />
      <Button kind="main" isDisabled={bring.isBusy || !wish['folders']} onClick={() => void bring.run()}>Import</Button>
      <Complaint error={bring.complaint} />
      {job && <JobLine job={job} />}
      {job?.result && <Outcome result={job.result} />}
    </details>
  );
}

function Outcome({result}: {result: unknown}) {
  const {shown, more, sentences} = importedOf(result);
  return (
    <>
      {shown.map((made) => <Made key={textIn(made, 'session')} made={made} />)}
      {more > 0 && <p>{more} more sessions</p>}
      {sentences.map((sentence) => <p key={sentence} class="dim">{sentence}</p>)}
    </>
  );
}

/** A session that is there now, with what was taken for granted; or why it is not. */
function Made({made}: {made: unknown}) {
  const name = textIn(made, 'session').replace(/.*\/|\.weft$/g, '');
  const {error} = fieldsOf(made);
  if (error) return <Complaint error={errorOf({error})} />;
  return <p><a href={`/sessions/${name}`}>{name}</a> <span class="dim">{textsIn(made, 'assumed').join('; ')}</span></p>;
}
