// SPDX-License-Identifier: Apache-2.0
// The finder, its light, and test shots.
import {useState} from 'preact/hooks';
import {ApiError} from '../../api/client';
import {rig} from '../../state/rig';
import {useKeys} from '../../state/keys';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {closeDevices, light, looks, openDevices, shootTest} from './devices';
import {cloth} from './cloth';
import {lightLed} from './led_strip';
import {showsEdges, showsGrid, turn} from './preferences';
import {chosen} from './proposal';

const first_us = 20_000;

/** What is typed, else what the last scan exposed with, else a fiftieth of a second. */
function exposureNow_us(): number {
  const {exposure_us, says, isWrong} = chosen.value;
  if (isWrong) throw new ApiError(says, cloth.value.exposure_ms, '', '', 0);
  return exposure_us ?? (rig.value?.exposure_us || first_us);
}

async function turnFinder(): Promise<void> {
  if (looks.value) return closeDevices();
  await openDevices();
  looks.value = true;
}

interface FinderControlsProps {
  onShot: () => void;
}

export function FinderControls({onShot}: FinderControlsProps) {
  const [led, setLed] = useState(1);
  const finder = useAction(turnFinder);
  const shot = useAction(async () => {
    await shootTest(typeof light.value === 'number' ? light.value : led, exposureNow_us());
    onShot();
  });
  useKeys('desk', [
    {key: 'v', does: 'live view', run: () => void finder.run()},
    {key: 't', does: 'test shot', run: () => void shot.run()},
    {key: 'g', does: 'grid', run: () => { showsGrid.value = !showsGrid.value; }},
    {key: 'e', does: 'edges that are sharp', run: () => { showsEdges.value = !showsEdges.value; }},
    {key: 'u', does: 'picture upside down', run: () => { turn.value = turn.value === '0' ? '180' : '0'; }},
    {key: 'r', does: 'light by all LEDs in turn', run: () => { light.value = 'round'; }},
    {key: 'o', does: 'no light but the room\'s', run: () => { light.value = 'room'; }},
    ...Array.from({length: 10}, (_, index) => ({
      key: String((index + 1) % 10), does: `light of LED ${index + 1}`, run: () => lightLed(index + 1),
    })),
  ]);
  const leds = rig.value?.devices.board.leds ?? 0;
  return (
    <div class="finder-controls">
      <div class="row">
        <Button keyHint="v" isPressed={looks.value} isDisabled={finder.isBusy || !rig.value?.can.includes('devices')} onClick={() => void finder.run()}>Live view</Button>
        {looks.value && <>
          <Button keyHint="g" isPressed={showsGrid.value} onClick={() => { showsGrid.value = !showsGrid.value; }}>Grid</Button>
          <Button keyHint="e" isPressed={showsEdges.value} onClick={() => { showsEdges.value = !showsEdges.value; }}>Edges</Button>
          <Button keyHint="r" isPressed={light.value === 'round'} onClick={() => { light.value = 'round'; }}>LEDs in turn</Button>
          <Button keyHint="o" isPressed={light.value === 'room'} onClick={() => { light.value = 'room'; }}>Room light</Button>
        </>}
        <span class="gap" />
        <label class="row"><span class="dim">by LED</span>
          <select value={led} aria-label="LED of the test shot" onChange={(event) => setLed(Number(event.currentTarget.value))}>
            {Array.from({length: leds}, (_, index) => <option key={index} value={index + 1}>{index + 1}</option>)}
          </select>
        </label>
        <Button keyHint="t" isDisabled={shot.isBusy || !rig.value?.can.includes('devices')} onClick={() => void shot.run()}>Test shot</Button>
      </div>
      <Complaint error={finder.complaint ?? shot.complaint} />
    </div>
  );
}
