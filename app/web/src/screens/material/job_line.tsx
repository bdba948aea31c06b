// SPDX-License-Identifier: Apache-2.0
import {titleOf} from '../../state/forms';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Mark} from '../../ui/mark';
import {Share} from '../../ui/share';
import {cancel} from '../jobs/jobs';
import {errorOf} from '../jobs/price';
import {hasEnded, type Job} from '../jobs/queue';

/** How a job is, with a way to end it; what went wrong of one that failed. */
export function JobLine({job}: {job: Job}) {
  if (job.state === 'failed') return <Complaint error={errorOf(job)} />;
  if (hasEnded(job)) return null;
  return (
    <div class="row">
      <Mark verdict={job.held ? 'waiting' : 'busy'}>{titleOf(job.kind)}: {job.phase || 'waits its turn'}</Mark>
      <Share label={titleOf(job.kind)} share={job.share} left_s={job.left_s} />
      <Button onClick={() => void cancel(job.id)}>Cancel</Button>
    </div>
  );
}
