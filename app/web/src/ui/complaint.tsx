// SPDX-License-Identifier: Apache-2.0
import type {ComponentChildren} from 'preact';
import type {ApiError} from '../api/client';
import {Copy} from './copy';

interface ComplaintProps {
  error: Pick<ApiError, 'what' | 'where' | 'why' | 'remedy'> | null;
  /** What can be done about it here. */
  children?: ComponentChildren;
}

/** An error where it happened, in the daemon's words. It stays until the action is tried again. */
export function Complaint({error, children}: ComplaintProps) {
  if (!error) return null;
  const text = [error.what, error.where, error.why, error.remedy].filter((line) => line !== '').join('\n');
  return (
    <div class="complaint" role="alert">
      <strong>{error.what}</strong>
      {error.where && <span class="where">{error.where}</span>}
      {error.why && <p>{error.why}</p>}
      {error.remedy && <p class="remedy">{error.remedy}</p>}
      <div class="row">
        {children}
        <Copy text={text} />
      </div>
    </div>
  );
}
