// SPDX-License-Identifier: Apache-2.0
import {useKeys} from '../../state/keys';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {lastWord, redo, undo} from './edits';

/** What was changed last, and the way back. `onStep` looks at the sessions again. */
export function LastWord({onStep}: {onStep: () => void}) {
  const back = () => void undo().then(onStep);
  const forth = () => void redo().then(onStep);
  useKeys('sessions', [
    {key: 'Ctrl+z', does: 'undo', run: back},
    {key: 'Ctrl+Shift+z', does: 'do it again', run: forth},
  ]);
  const {says, error} = lastWord.value;
  return (
    <div class="last-word">
      <div class="row">
        <span class="says dim" role="status">{says}</span>
        <Button kind="quiet" onClick={back} label="Undo">Undo</Button>
        <Button kind="quiet" onClick={forth} label="Redo">Redo</Button>
      </div>
      <Complaint error={error} />
    </div>
  );
}
