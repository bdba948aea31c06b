// SPDX-License-Identifier: Apache-2.0
import type {Schemas} from '../../api/client';

const channels = ['red', 'green', 'blue'] as const;

function outlineOf(bins: readonly number[]): string {
  const most = Math.log1p(Math.max(1, ...bins));
  return bins.map((count, bin) => `${bin},${(1 - Math.log1p(count) / most).toFixed(3)}`).join(' ');
}

/** Counts by channel from black to white, on a logarithmic scale. */
export function HistogramPlot({of, label}: {of: Schemas['Histogram']; label: string}) {
  return (
    <svg class="histogram" viewBox="0 0 63 1" preserveAspectRatio="none" role="img" aria-label={label}>
      {channels.map((channel) => <polyline key={channel} class={channel} points={outlineOf(of[channel].bins)} />)}
    </svg>
  );
}
