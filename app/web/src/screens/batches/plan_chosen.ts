// SPDX-License-Identifier: Apache-2.0
import {go} from '../../state/address';
import {chosenKey} from './plan';

/** To the form that plans these sessions, by another calibration than their own where one is named. */
export function planChosen(sessions: readonly string[], calibration?: string): void {
  sessionStorage.setItem(chosenKey, JSON.stringify({sessions, calibration}));
  go('/batches?plan=chosen');
}
