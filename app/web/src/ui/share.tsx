// SPDX-License-Identifier: Apache-2.0
import {durationOf} from './words';

interface ShareProps {
  label: string;
  /** 0 to 1; null: not known. */
  share: number | null;
  left_s?: number | null;
}

/** How far something is, and the seconds that it still takes. */
export function Share({label, share, left_s}: ShareProps) {
  return (
    <div class="share">
      <progress aria-label={label} max={1} value={share ?? undefined} />
      <span class="numbers">
        {share === null ? '' : `${Math.round(share * 100)} %`}
        {left_s != null && `, ${durationOf(left_s)} left`}
      </span>
    </div>
  );
}
