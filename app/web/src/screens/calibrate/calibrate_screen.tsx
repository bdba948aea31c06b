// SPDX-License-Identifier: Apache-2.0
import './calibrate.css';
import {place} from '../../state/address';
import {useCalibrations} from './calibrations';
import {Overview} from './overview';
import {WalkPage} from './walk_page';
import type {Walk} from './walk';

/** /calibrate: how well the rig is known; /calibrate/all/NAME and /calibrate/refresh/NAME: the way to know it better. */
export default function CalibrateScreen() {
  useCalibrations();
  const walk = walkOf(place.value.parts);
  return walk ? <WalkPage key={`${walk.kind}/${walk.name}`} walk={walk} /> : <Overview />;
}

function walkOf([kind, name]: readonly string[]): Walk | null {
  return (kind === 'all' || kind === 'refresh') && name !== undefined ? {kind, name} : null;
}
