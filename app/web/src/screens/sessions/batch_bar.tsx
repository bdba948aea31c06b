// SPDX-License-Identifier: Apache-2.0
// What can be done with all chosen sessions at once: tags, and jobs for each.
import {useState} from 'preact/hooks';
import {asApiError, type ApiError, type Schemas} from '../../api/client';
import {levels, type Quality} from '../../state/forms';
import {Button} from '../../ui/button';
import {Choice} from '../../ui/choice';
import {Complaint} from '../../ui/complaint';
import {Field} from '../../ui/field';
import {counted} from '../../ui/say';
import {planChosen} from '../batches/plan_chosen';
import {queueJob} from '../jobs/jobs';
import {change} from './edits';
import {compare} from './session_tile';
import {tagsIn, withTags, withoutTag, type Summary} from './metadata';
import {tags} from './shelf';

interface BatchBarProps {
  chosen: readonly Summary[];
  onAll: () => void;
  onNone: () => void;
  /** After something of them changed. */
  onChanged: () => void;
}

interface Failure {
  name: string;
  error: ApiError;
}

export function BatchBar({chosen, onAll, onNone, onChanged}: BatchBarProps) {
  const [typed, type] = useState('');
  const [quality, setQuality] = useState<Quality>('standard');
  const [failures, setFailures] = useState<readonly Failure[]>([]);
  const [queued, setQueued] = useState(0);
  const [isBusy, setBusy] = useState(false);

  /** One after another; what fails is told by name and stops nothing. */
  const each = async (act: (session: Summary) => Promise<unknown>) => {
    const failed: Failure[] = [];
    setBusy(true);
    setQueued(0);
    for (const session of chosen) {
      await act(session).catch((error: unknown) => failed.push({name: session.name, error: asApiError(error)}));
    }
    setFailures(failed);
    setBusy(false);
    return chosen.length - failed.length;
  };
  const retag = async (tagsOf: (session: Summary) => string[]) => {
    await each((session) => change(session.name, {tags: tagsOf(session), revision: session.revision}));
    type('');
    onChanged();
  };
  const addTags = () => void retag((session) => withTags(session.tags, tagsIn(typed)));
  const removeTags = () => void retag((session) => tagsIn(typed).reduce(withoutTag, session.tags));
  const queue = async (request: (session: string) => Schemas['JobRequest']) => {
    setQueued(await each((session) => queueJob(request(session.name))));
  };

  const [one, other] = chosen;
  const plan = () => planChosen(chosen.map(({name}) => name));

  return (
    <section class="batch" aria-label="Chosen sessions">
      <div class="row">
        <strong>{counted(chosen.length, 'session')} chosen</strong>
        <Button kind="quiet" onClick={onAll}>All</Button>
        <Button kind="quiet" onClick={onNone} keyHint="Escape">None</Button>
        {one && other && chosen.length === 2 && <Button onClick={() => compare(one, other)}>Compare</Button>}
      </div>
      <div class="row ends">
        <Field label="Tags" value={typed} onInput={type} onEnter={addTags} list={tags.value} placeholder="autumn, red" />
        <Button isDisabled={isBusy || tagsIn(typed).length === 0} onClick={addTags}>Add</Button>
        <Button isDisabled={isBusy || tagsIn(typed).length === 0} onClick={removeTags}>Take off</Button>
      </div>
      <div class="row ends">
        <Choice label="Level" value={quality} options={levels().map((value) => ({value, says: value}))} onChange={setQuality} />
        <Button kind="main" isDisabled={isBusy} onClick={() => void queue((session) => ({kind: 'solve', session, quality}))}>Solve</Button>
        <Button isDisabled={isBusy} onClick={() => void queue((session) => ({kind: 'price', session}))}>Price</Button>
        <Button isDisabled={isBusy} onClick={() => void queue((session) => ({kind: 'rectify', session}))}>Rectify</Button>
        <Button onClick={plan}>Plan a night...</Button>
      </div>
      {queued > 0 && <p role="status"><a href="/jobs">{counted(queued, 'job')} queued</a></p>}
      {failures.map(({name, error}) => <Complaint key={name} error={{...error, what: `${name}: ${error.what}`}} />)}
    </section>
  );
}
