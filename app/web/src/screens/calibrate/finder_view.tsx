// SPDX-License-Identifier: Apache-2.0
// The picture of the finder, with the pose that is wanted and the board that is seen drawn over it.
import {useSignalEffect} from '@preact/signals';
import {useEffect, useRef} from 'preact/hooks';
import {rig} from '../../state/rig';
import {useAction} from '../../ui/action';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {followFinder, framing, looks, openDevices, picture, trouble, type Framing} from '../desk/devices';
import {pointsIn, type XY} from './photograph_set';

interface FinderViewProps {
  /** The pose that is wanted, in shares of the picture. */
  wanted: readonly XY[] | null;
  /** What the last photograph was found to show. */
  found: readonly XY[] | null;
}

export function FinderView({wanted, found}: FinderViewProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const open = useAction(async () => {
    await openDevices();
    looks.value = true;
  });
  useEffect(followFinder, []);
  useSignalEffect(() => {
    const shown = canvas.current;
    if (shown && picture.value) shown.getContext('2d')?.drawImage(picture.value, 0, 0, shown.width, shown.height);
  });
  const seen = framing.value;
  const says = seen?.says || 'Nothing is seen yet.';
  return (
    <figure class="aim">
      <div class="sight">
        <canvas ref={canvas} width={640} height={424} role="img" aria-label={says} />
        <Outlines wanted={wanted} found={found} seen={seen} />
        {!looks.value && (
          <div class="closed">
            <Button isDisabled={open.isBusy || !rig.value?.can.includes('devices')} onClick={() => void open.run()}>
              Look through the camera
            </Button>
          </div>
        )}
      </div>
      <figcaption class="dim">{says} {found && 'The thin line is where it lay in the last photograph. '}For framing only: the camera chooses its exposure.</figcaption>
      <Complaint error={open.complaint ?? trouble.value} />
    </figure>
  );
}

function Outlines({wanted, found, seen}: FinderViewProps & {seen: Framing | null}) {
  const shape = seen?.board ?? seen?.sheet;
  return (
    <svg class="outlines" viewBox="0 0 1 1" preserveAspectRatio="none" aria-hidden="true">
      {seen?.tags.map((tag, index) => <polygon key={index} class="tag-seen" points={said(pointsIn(tag.corners))} />)}
      {shape && <polygon class="seen" points={said(pointsIn(shape.corners))} />}
      {found && <polygon class="found" points={said(found)} />}
      {wanted && <polygon class="wanted" points={said(wanted)} />}
    </svg>
  );
}

function said(points: readonly XY[]): string {
  return points.map(([x, y]) => `${x},${y}`).join(' ');
}
