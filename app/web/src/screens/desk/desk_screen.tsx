// SPDX-License-Identifier: Apache-2.0
// The desk: frame, focus, say what cloth it is, scan, look, next.
import './desk.css';
import {computed, useSignalEffect} from '@preact/signals';
import {useEffect, useState} from 'preact/hooks';
import {answer, api, type Schemas} from '../../api/client';
import {onEvent} from '../../api/events';
import {isDark} from '../../state/dark';
import {Empty} from '../../ui/empty';
import {ClothForm} from './cloth_form';
import {followFinder, looks, shots, takeShot} from './devices';
import {FinderControls} from './finder_controls';
import {LastScan} from './last_scan';
import {LedStrip} from './led_strip';
import {Finder} from './live_view';
import {followProposal} from './proposal';
import {followScanned, scanned, showsScanned} from './scan';
import {focusOn, nextButton, scanButton, ScanControls} from './scan_controls';
import {TestShotView} from './test_shot';

interface Calibrated {
  /** The parts that the rig's calibration has; null: it is not known yet. */
  parts: readonly string[] | null;
  /** Where it has the table's tags. */
  tags: readonly Schemas['FramedShape'][];
}

async function askCalibrated(): Promise<Calibrated> {
  const {calibrations} = await answer(api.GET('/api/v1/calibrations'));
  const parts = calibrations.find(({is_rigs}) => is_rigs)?.parts ?? [];
  const tags = parts.includes('camera') ? (await answer(api.GET('/api/v1/rig/framing'))).tags : [];
  return {parts, tags};
}

function useCalibrated(): Calibrated {
  const [calibrated, setCalibrated] = useState<Calibrated>({parts: null, tags: []});
  useEffect(() => {
    askCalibrated().then(setCalibrated, () => {});
  }, []);
  return calibrated;
}

const wantedParts = ['camera', 'response', 'lights'];

/** With nothing to look at yet: what to do first. */
function FirstSteps({parts}: Pick<Calibrated, 'parts'>) {
  const missing = wantedParts.filter((part) => parts && !parts.includes(part));
  if (missing.length > 0) {
    return (
      <Empty says={`This rig is not calibrated yet: ${missing.join(', ')} missing. What is scanned now cannot be solved.`}>
        <a class="button main" href="/calibrate">Calibrate it</a>
        <a href="/doctor">Or look first whether all is well with it</a>
      </Empty>
    );
  }
  return (
    <Empty says="Nothing to look at yet.">
      <ol>
        <li>Lay a cloth on the table. <kbd>v</kbd> shows what the camera sees.</li>
        <li><kbd>t</kbd> takes a test shot: it tells how sharp and how bright it is.</li>
        <li><kbd>n</kbd> begins a cloth: type what it is, press Enter, then <kbd>Space</kbd>.</li>
      </ol>
      <p><a href="/doctor">What is wrong with the rig, if anything</a></p>
      <p><a href="/calibrate">How well it is calibrated</a></p>
    </Empty>
  );
}

function Stage() {
  const {parts, tags} = useCalibrated();
  const done = showsScanned.value ? scanned.value : null;
  if (done) return <LastScan session={done} />;
  if (looks.value || shots.value.length > 0) {
    return (
      <div class="looks">
        {looks.value && <Finder belongs={tags} />}
        <TestShotView />
      </div>
    );
  }
  return <FirstSteps parts={parts} />;
}

const canGoOn = computed(() => !isDark.value && showsScanned.value && scanned.value !== null);

/** Once it is light again the hands go on where they would: to the next cloth. */
function useFocusAfterScan(): void {
  useSignalEffect(() => {
    if (canGoOn.value) requestAnimationFrame(() => focusOn(nextButton));
  });
}

export default function DeskScreen() {
  useEffect(followProposal, []);
  useEffect(followFinder, []);
  useEffect(followScanned, []);
  useEffect(() => onEvent('shot', takeShot), []);
  useFocusAfterScan();
  return (
    <div class="desk">
      <section class="stage" aria-labelledby="desk-title">
        <h1 id="desk-title" class="unseen">Desk</h1>
        <FinderControls onShot={() => { showsScanned.value = false; }} />
        <div class="view" tabIndex={0} role="group" aria-label="What there is to look at"><Stage /></div>
        <LedStrip />
      </section>
      <aside class="side" aria-label="Scan">
        <ScanControls><ClothForm onSaid={() => focusOn(scanButton)} /></ScanControls>
      </aside>
    </div>
  );
}
