// SPDX-License-Identifier: Apache-2.0
// What is hard in each stage, what a plain formula makes of it, and weft; and a scene of pixels that are hard to solve.
import {go} from '../../state/address';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {listIn, numberIn, textIn} from '../../ui/fields';
import {counted} from '../../ui/say';
import {Share} from '../../ui/share';
import {Table} from '../../ui/table';
import {addressOfViewer, FIRST_SIGHT} from '../viewer/sight';
import {jobs, queueJob} from './jobs';
import {errorOf} from './price';
import {hasEnded} from './queue';

export function AskHardCases() {
  const ask = useAction(async () => {
    await queueJob({kind: 'torture'});
    go('/jobs?hard');
  });
  return (
    <>
      <Button isDisabled={ask.isBusy} onClick={() => void ask.run()}>Hard cases</Button>
      <p class="dim">What is hard in each stage: how far off a plain formula is, and weft, and what weft says of it.</p>
      <Complaint error={ask.complaint} />
    </>
  );
}

function offOf(document: unknown, key: string, none: string) {
  const off = numberIn(document, key);
  return off === null ? none : Number(off.toPrecision(2));
}

/** Those of the newest job that looked at them. */
export function HardCases() {
  const job = jobs.value.find(({kind}) => kind === 'torture');
  if (!job) return null;
  const {result} = job;
  const solve = textIn(result, 'id');
  const cases = listIn(result, 'cases');
  return (
    <section class="panel" aria-labelledby="hard-title">
      <h2 id="hard-title">Hard cases</h2>
      {!hasEnded(job) && <Share label="Hard cases" share={job.share} left_s={job.left_s} />}
      {job.state === 'failed' && <Complaint error={errorOf(job)} />}
      {solve && <>
        <p>
          {counted(cases.length, 'case')}, {numberIn(result, 'off')} off their bounds. <a href={addressOfViewer({session: textIn(result, 'session'), solve}, {...FIRST_SIGHT, layer: 'status'})}>Hard pixels in one picture</a>
        </p>
        <Table caption="Hard cases" heads={['Case', 'Stage', 'Plain formula', 'weft', 'off, in', 'weft says']}
          rows={cases.map((each) => ({
            key: textIn(each, 'what'),
            cells: [textIn(each, 'what'), textIn(each, 'stage'), offOf(each, 'plain', 'no number'), offOf(each, 'ours', '-'), textIn(each, 'unit'), textIn(each, 'flag')],
          }))} />
      </>}
    </section>
  );
}
