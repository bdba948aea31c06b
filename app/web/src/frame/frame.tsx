// SPDX-License-Identifier: Apache-2.0
// What is around every screen: where one can go, how the rig is, and what is wrong with the connection.
import type {ComponentChildren} from 'preact';
import {useState} from 'preact/hooks';
import {everywhere, useKeys} from '../state/keys';
import {place} from '../state/address';
import {connection, isOutdated, rig} from '../state/rig';
import {runningJob} from '../state/running_job';
import {Button} from '../ui/button';
import {Mark} from '../ui/mark';
import {Share} from '../ui/share';
import {Controls} from './controls';
import {KeyList} from './key_list';
import {VirtualRig} from './virtual_rig';
import {silenceInWords, stateInWords, verdictOf} from './words';

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

/** Of what is not heard nothing is claimed. */
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
      {rig.value?.warnings.map((warning) => <div key={warning} class="strip warning" role="status">{warning}</div>)}
    </>
  );
}

function toggleFullscreen(): void {
  if (document.fullscreenElement) void document.exitFullscreen();
  else void document.documentElement.requestFullscreen?.();
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
        <a class="mark-of-weft" href="/desk" aria-label="weft">weft</a>
        <Tabs />
        <RunningJob />
        <RigState />
        <Button kind="quiet" label="Keys" onClick={() => showKeys(true)}>?</Button>
      </header>
      <Warnings />
      <main class={connection.value.state === 'silent' ? 'stale' : ''}>{children}</main>
      {rig.value?.virtual && <VirtualRig />}
      {showsKeys && <KeyList onClose={() => showKeys(false)} />}
    </>
  );
}
