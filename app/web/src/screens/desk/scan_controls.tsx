// SPDX-License-Identifier: Apache-2.0
// The one Scan key, and what can be done while a scan runs.
import type {ComponentChildren} from 'preact';
import {useEffect, useRef, useState} from 'preact/hooks';
import {rig} from '../../state/rig';
import {useKeys} from '../../state/keys';
import {useAction, type Action} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Dialog} from '../../ui/dialog';
import {Field} from '../../ui/field';
import {Share} from '../../ui/share';
import {cloth, forgetCloth} from './cloth';
import {exposureField} from './cloth_form';
import {holdOf} from './hold';
import {chosen, proposal} from './proposal';
import {ask, beginScan, goOnWith, pauseOrGoOn, scanned, showsScanned} from './scan';

export const scanButton = 'scan';
export const nextButton = 'next-cloth';

export function focusOn(id: string): void {
  document.getElementById(id)?.focus();
}

export function nextCloth(): void {
  forgetCloth();
  showsScanned.value = false;
  focusOn('fabric');
}

function Cancel({onClose}: {onClose: () => void}) {
  const cancel = useAction(() => ask('cancel'));
  return (
    <Dialog title="Cancel the scan?" onClose={onClose}>
      <p>The shot on its way is finished. What is photographed is kept, and goes on from there.</p>
      <Complaint error={cancel.complaint} />
      <form method="dialog" class="row">
        <Button kind="danger" onClick={() => void cancel.run().then((done) => done && onClose())}>Cancel the scan</Button>
        <Button type="submit">Go on</Button>
      </form>
    </Dialog>
  );
}

/** While it runs, and where it stopped. */
function Running({hold, onCancel}: {hold: Action; onCancel: () => void}) {
  const status = rig.value;
  if (!status) return null;
  const can = holdOf(status);
  return (
    <div class="running">
      <strong>{status.session}</strong>
      <Share label="Photographs" share={status.frames_planned > 0 ? status.frames / status.frames_planned : null} left_s={status.left_s} />
      <p class="dim">{status.frames} of {status.frames_planned} photographs. {!status.error && status.why}</p>
      <div class="row">
        {can === 'pause' && <Button keyHint="p" isDisabled={hold.isBusy} onClick={() => void hold.run()}>Pause</Button>}
        {can === 'resume' && <Button kind="main" keyHint="p" isDisabled={hold.isBusy} onClick={() => void hold.run()}>Go on</Button>}
        {status.can.includes('cancel') && <Button keyHint="Esc" onClick={onCancel}>Cancel</Button>}
      </div>
      <Complaint error={status.error} />
      <Complaint error={hold.complaint} />
    </div>
  );
}

/** Why the rig may be scanned with although it has moved: kept with the session. */
function Moved({reason, onInput}: {reason: string; onInput: (reason: string) => void}) {
  return (
    <>
      <p><a href="/calibrate">Check the rig again</a>, or say why it is scanned all the same:</p>
      <Field label="Reason" value={reason} onInput={onInput} />
    </>
  );
}

/** The last scan that did not end. */
function Unfinished() {
  const {resumable = [], phase, session, can = []} = rig.value ?? {};
  const [name = '', ...others] = phase === 'cancelled' && session ? [session, ...resumable] : resumable;
  const goOn = useAction(() => goOnWith(name));
  if (!name) return null;
  return (
    <div class="panel">
      <Button isDisabled={goOn.isBusy || !can.includes('scan')} onClick={() => void goOn.run()}>Go on with {name}</Button>
      {others.length > 0 && <a href="/sessions">{others.length} more did not end</a>}
      <Complaint error={goOn.complaint} />
    </div>
  );
}

/** What is said of the scan scrolls with the form; its button is always there. */
export function ScanControls({children}: {children: ComponentChildren}) {
  const [asksToCancel, askToCancel] = useState(false);
  const [reason, setReason] = useState('');
  const scan = useAction(() => beginScan(reason));
  const hold = useAction(pauseOrGoOn);
  const status = rig.value;
  const can = status?.can ?? [];
  const isReady = can.includes('scan') && cloth.value.fabric.trim() !== '' && !chosen.value.isWrong && !scan.isBusy;
  const start = () => {
    if (isReady) void scan.run();
    else if (can.includes('scan')) focusOn(chosen.value.isWrong ? exposureField : 'fabric');
  };
  useKeys('desk', [
    {key: 'Space', does: 'scan', run: start},
    {key: 'Escape', does: 'cancel the scan (asks)', run: () => askToCancel(rig.value?.can.includes('cancel') ?? false)},
    {key: 'p', does: 'pause the scan, or go on', run: () => void hold.run()},
    {key: 'n', does: 'next cloth', run: nextCloth},
  ]);
  const said = useRef<HTMLDivElement>(null);
  const fault = status?.error?.what ?? scan.complaint?.what;
  useEffect(() => said.current?.scrollTo(0, 0), [fault]);
  if (!status) return null;
  const isAtWork = ['connecting', 'scanning', 'paused'].includes(status.state);
  const isDone = showsScanned.value && scanned.value !== null;
  return (
    <>
      <div ref={said} class="said">
        {isAtWork || status.error ? <Running hold={hold} onCancel={() => askToCancel(true)} /> : <Unfinished />}
        {![status.error?.what, proposal.value.refused?.what].includes(scan.complaint?.what) && <Complaint error={scan.complaint} />}
        {scan.complaint?.code === 'rig_moved' && <Moved reason={reason} onInput={setReason} />}
        {children}
      </div>
      <div class="scan-controls">
        {!isAtWork && isDone && <Button id={nextButton} kind="main" keyHint="n" onClick={nextCloth}>Next cloth</Button>}
        {!isAtWork && !isDone && <Button id={scanButton} kind="main" keyHint="Space" isDisabled={!isReady} onClick={start}>Scan</Button>}
      </div>
      {asksToCancel && <Cancel onClose={() => askToCancel(false)} />}
    </>
  );
}
