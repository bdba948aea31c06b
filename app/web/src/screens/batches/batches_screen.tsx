// SPDX-License-Identifier: Apache-2.0
import '../jobs/jobs.css';
import './batches.css';
import {useEffect, useState} from 'preact/hooks';
import {answer, api, asApiError, type ApiError, type Schemas} from '../../api/client';
import {place} from '../../state/address';
import {Complaint} from '../../ui/complaint';
import {Empty} from '../../ui/empty';
import {Table} from '../../ui/table';
import {durationOf, timeOf} from '../../ui/words';
import {useJobs} from '../jobs/jobs';
import {BatchPage} from './batch_page';
import {scopeIn} from './plan';
import {PlanForm} from './plan_form';

export default function BatchesScreen() {
  useJobs();
  const [name] = place.value.parts;
  return name === undefined ? <Batches /> : <BatchPage key={name} name={name} />;
}

function Batches() {
  const [batches, setBatches] = useState<Schemas['Batch'][] | null>(null);
  const [complaint, complain] = useState<ApiError | null>(null);
  const scope = scopeIn(place.value.query);
  useEffect(() => {
    answer(api.GET('/api/v1/batches')).then((said) => setBatches(said.batches), (error: unknown) => complain(asApiError(error)));
  }, []);
  return (
    <div class="page batches">
      <h1>Batches</h1>
      <Complaint error={complaint} />
      {scope && <PlanForm scope={scope} />}
      {!scope && batches?.length === 0 && <Empty says="Nothing was planned yet."><a href="/sessions">Choose sessions in the library</a></Empty>}
      {batches && batches.length > 0 && (
        <Table caption="Batches" heads={['Batch', 'Asked', 'Sessions', 'Left out', 'Takes', 'How it is']}
          rows={batches.map((each) => ({
            key: each.name,
            cells: [
              <a href={`/batches/${each.name}`}>{each.name}</a>, timeOf(each.created), each.sessions, each.left_out,
              durationOf(each.seconds), each.fault || (each.has_report ? 'report' : each.is_planned ? 'planned' : 'no plan'),
            ],
          }))} />
      )}
    </div>
  );
}
