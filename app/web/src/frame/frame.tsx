// SPDX-License-Identifier: Apache-2.0
// What is around every screen: where one can go, how the rig is, and what is wrong with the connection.
import type {ComponentChildren, ComponentType} from 'preact';
import {useState} from 'preact/hooks';
import {answer, api} from '../api/client';
import {everywhere, registry, useKeys} from '../state/keys';
import {place} from '../state/address';
import {connection, isOutdated, rig} from '../state/rig';
import {runningJob} from '../state/running_job';
import {useAction} from '../ui/action';
import {Button} from '../ui/button';
import {Complaint} from '../ui/complaint';
import {Dialog} from '../ui/dialog';
import {Mark} from '../ui/mark';
import {Share} from '../ui/share';
import {silenceInWords, stateInWords, verdictOf, verdictOfPlace} from './rig_words';

const tabs = [
  {screen: 'desk', says: 'Desk'},
  {screen: 'sessions', says: 'Library'},
  {screen: 'viewer', says: 'Viewer'},
  {screen: 'material', says: 'Material'},
  {screen: 'calibrate', says: 'Calibrate'},
  {screen: 'jobs', says: 'Jobs'},
  {screen: 'doctor', says: 'Doctor'},
];

function Tabs() {
  return (
    <nav aria-label="Screens">
      {tabs.map(({screen, says}) => (
        <a key={screen} href={`/${screen}`} aria-current={screen === place.value.screen ? 'page' : undefined}>{says}</a>
      ))}
    </nav>
  );
}

/** This page never keeps the rig to itself: what it takes from somebody else it gives back to all. */
async function freeControls(): Promise<void> {
  const {control} = await answer(api.POST('/api/v1/control', {body: {name: 'a page', take: true}}));
  await answer(api.DELETE('/api/v1/control', {headers: {'X-Weft-Control': control}}));
}

function Controls({holder}: {holder: string}) {
  const take = useAction(freeControls);
  return (
    <>
      <span class="dim">{holder} has the controls</span>
      <Button kind="quiet" isDisabled={take.isBusy} onClick={() => void take.run()}>Take the controls</Button>
      <Complaint error={take.complaint} />
    </>
  );
}

/** Nothing is claimed of a rig that is not heard. */
function RigState() {
  const status = rig.value;
  if (!status) return null;
  if (connection.value.state === 'silent') {
    return <div class="rig" role="status"><span class="name">{status.rig}</span><Mark verdict="waiting">no word</Mark></div>;
  }
  const isScanning = status.frames_planned > 0 && ['scanning', 'paused'].includes(status.state);
  return (
    <div class="rig" role="status">
      <span class="name">{status.rig}</span>
      <Mark verdict={verdictOf(status)}>{stateInWords(status)}</Mark>
      {status.place && (
        <a class="place" href="/calibrate" title={status.place.says}>
          <Mark verdict={verdictOfPlace(status.place)}>{status.place.says}</Mark>
        </a>
      )}
      {status.controls && <Controls holder={status.controls} />}
      {isScanning && <Share label="Scan" share={status.frames / status.frames_planned} left_s={status.left_s} />}
    </div>
  );
}

function RunningJob() {
  const job = runningJob.value;
  if (!job || connection.value.state === 'silent') return null;
  return (
    <a class="job" href="/jobs">
      {job.kind} {job.of}
      {job.held ? <span class="dim">waits for the scan</span> : <Share label={`Job ${job.kind}`} share={job.share} left_s={job.left_s} />}
    </a>
  );
}

function Warnings() {
  const {state, age_s} = connection.value;
  return (
    <>
      {state === 'silent' && (
        <div class="strip fault" role="alert">
          {silenceInWords(age_s)} What is shown may be old; the page asks again by itself.
          <Button onClick={() => location.reload()}>Reload</Button>
        </div>
      )}
      {isOutdated.value && (
        <div class="strip warning" role="alert">
          The daemon is of another version than this page.
          <Button onClick={() => location.reload()}>Reload</Button>
        </div>
      )}
    </>
  );
}

function toggleFullscreen(): void {
  if (document.fullscreenElement) void document.exitFullscreen();
  else void document.documentElement.requestFullscreen?.();
}

/** A rig that is not there can be broken; the panel for that is fetched when a key asks for it. */
function VirtualRig() {
  const [panel, setPanel] = useState<{Panel: ComponentType} | null>(null);
  const toggle = async () => {
    const {VirtualPanel} = await import('./virtual_panel');
    setPanel(panel ? null : {Panel: VirtualPanel});
  };
  useKeys(everywhere, [{key: 'V', does: 'break this virtual rig, lay its table', run: () => void toggle()}]);
  return panel && <panel.Panel />;
}

function KeyList({onClose}: {onClose: () => void}) {
  return (
    <Dialog title="Keys" onClose={onClose}>
      {[...registry.value].map(([screen, keys]) => (
        <section key={screen}>
          <h3>{screen}</h3>
          <dl class="keys">
            {keys.map(({key, does}) => (
              <div key={key}>
                <dt><kbd>{key}</kbd></dt>
                <dd>{does}</dd>
              </div>
            ))}
          </dl>
        </section>
      ))}
      <form method="dialog"><button class="button">Close</button></form>
    </Dialog>
  );
}

export function Frame({children}: {children: ComponentChildren}) {
  const [showsKeys, showKeys] = useState(false);
  useKeys(everywhere, [
    {key: '?', does: 'list of keys', run: () => showKeys(true)},
    {key: 'f', does: 'full screen', run: toggleFullscreen},
  ]);
  return (
    <>
      <header>
        <a class="mark-of-weft" href="/tour">weft</a>
        <Tabs />
        <RunningJob />
        <RigState />
        <a class="button quiet" href="/tour">Tour</a>
        <Button kind="quiet" label="Keys" onClick={() => showKeys(true)}>?</Button>
      </header>
      <Warnings />
      <main class={connection.value.state === 'silent' ? 'stale' : ''}>{children}</main>
      {rig.value?.virtual && <VirtualRig />}
      {showsKeys && <KeyList onClose={() => showKeys(false)} />}
    </>
  );
}
