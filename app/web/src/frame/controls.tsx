// SPDX-License-Identifier: Apache-2.0
// Who keeps the rig to himself. This page never does: what it takes from somebody else it gives back to all.
import {answer, api} from '../api/client';
import {useAction} from '../ui/action';
import {Button} from '../ui/button';
import {Complaint} from '../ui/complaint';

async function freeControls(): Promise<void> {
  const {control} = await answer(api.POST('/api/v1/control', {body: {name: 'a page', take: true}}));
  await answer(api.DELETE('/api/v1/control', {headers: {'X-Weft-Control': control}}));
}

export function Controls({holder}: {holder: string}) {
  const take = useAction(freeControls);
  return (
    <>
      <span class="dim">{holder} has the controls</span>
      <Button kind="quiet" isDisabled={take.isBusy} onClick={() => void take.run()}>Take the controls</Button>
      <Complaint error={take.complaint} />
    </>
  );
}
