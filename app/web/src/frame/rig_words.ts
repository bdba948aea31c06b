// SPDX-License-Identifier: Apache-2.0
import type {Schemas} from '../api/client';
import type {Verdict} from '../ui/mark';
import {durationOf} from '../ui/words';

type Status = Schemas['Status'];

/** A connection that broke is known at once, before there was any silence. */
export function silenceInWords(age_s: number): string {
  if (age_s === 0) return 'The daemon does not answer.';
  return `The daemon has said nothing for ${age_s < 10 ? `${age_s} s` : durationOf(age_s)}.`;
}

/** What the rig does, as a person would say it. */
export function stateInWords(status: Status): string {
  const light = status.led > 0 ? `LED ${status.led}` : 'the dark shot';
  switch (status.state) {
    case 'idle':
      return 'ready';
    case 'attended':
      return status.error ? 'stopped by a fault, devices open' : 'ready, devices open';
    case 'connecting':
      return 'looking for its devices';
    case 'paused':
      return 'paused';
    case 'failed':
      return 'stopped by a fault';
    case 'scanning':
      break;
  }
  switch (status.phase) {
    case 'metering':
      return 'measuring the exposure';
    case 'cooling':
      return 'waiting for a LED to cool';
    case 'exposing':
      return `photographing ${light}`;
    case 'fetching':
      return `fetching ${light}`;
    case 'recovering':
      return 'waiting for a device';
    default:
      return 'finishing the scan';
  }
}

export function verdictOf(status: Status): Verdict {
  if (status.error) return 'fault';
  if (status.state === 'paused' || status.phase === 'recovering') return 'warning';
  return status.state === 'idle' || status.state === 'attended' ? 'fine' : 'busy';
}

const verdictsOfPlace: Record<NonNullable<Status['place']>['state'], Verdict> = {
  'in place': 'fine', dimmed: 'warning', moved: 'fault', unexplained: 'fault', 'not seen': 'waiting',
};

/** How the rig stands to its calibration, by its last scan. */
export function verdictOfPlace(place: NonNullable<Status['place']>): Verdict {
  return verdictsOfPlace[place.state];
}
