// SPDX-License-Identifier: Apache-2.0
import {Mark} from '../../ui/mark';

export function SessionState({state}: {state: string}) {
  if (state === 'complete') return <Mark verdict="fine">complete</Mark>;
  if (state === 'capturing') return <Mark verdict="waiting">unfinished</Mark>;
  return <Mark verdict="fault">{state}</Mark>;
}
