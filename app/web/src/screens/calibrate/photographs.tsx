// SPDX-License-Identifier: Apache-2.0
import {Button} from '../../ui/button';
import {Mark} from '../../ui/mark';
import {digits} from '../../ui/say';
import {factsOf, largestResidual, residualOf, wantedOf, type Photograph, type PhotographSet} from './photograph_set';

interface PhotographsProps {
  set: PhotographSet;
  onLeaveOut: (name: string, out: boolean) => void;
}

/** Each photograph with its answer: taken, or why not; the newest first. */
export function Photographs({set, onLeaveOut}: PhotographsProps) {
  const most = largestResidual(set);
  const ordered = [...set.photographs].reverse();
  return (
    <ul class="photographs">
      {ordered.map((photograph) => (
        <li key={photograph.name}>
          <strong>{photograph.name}</strong>
          {wantedOf(photograph) === null && (
            <Button kind="quiet" isDisabled={set.busy} label={`${photograph.left_out ? 'Take back' : 'Leave out'} ${photograph.name}`}
              onClick={() => onLeaveOut(photograph.name, !photograph.left_out)}>
              {photograph.left_out ? 'Take back' : 'Leave out'}
            </Button>
          )}
          <Answer photograph={photograph} />
          <Residual photograph={photograph} most={most} />
        </li>
      ))}
    </ul>
  );
}

export function Answer({photograph}: {photograph: Photograph}) {
  if (photograph.used) return <Mark verdict="fine">{['taken', ...factsOf(photograph)].join(', ')}</Mark>;
  if (wantedOf(photograph) !== null) return <Mark verdict="waiting">to be taken</Mark>;
  if (photograph.left_out) return <Mark verdict="waiting">left out: {photograph.why}</Mark>;
  return <Mark verdict="warning">not used: {photograph.why}</Mark>;
}

function Residual({photograph, most}: {photograph: Photograph; most: number}) {
  const residual = residualOf(photograph);
  if (residual === null || most === 0) return null;
  return (
    <span class="residual">
      <meter aria-label={`Residual of ${photograph.name}`} min={0} max={most} value={residual} />
      <span class="dim numbers">{digits(residual)} px</span>
    </span>
  );
}
