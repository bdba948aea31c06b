// SPDX-License-Identifier: Apache-2.0
import type {Coverage} from './photograph_set';

/** Where in the picture corners were seen, as it lies before the eyes. */
export function CoverageMap({coverage}: {coverage: Coverage}) {
  const {columns, corners, seen} = coverage;
  const most = Math.max(1, ...corners);
  const says = `${seen} of ${corners.length} parts of the picture have corners`;
  return (
    <figure class="coverage">
      <div class="cells" role="img" aria-label={says} style={{gridTemplateColumns: `repeat(${columns}, 1fr)`}}>
        {corners.map((count, index) => (
          <span key={index} class={count > 0 ? 'cell' : 'cell none'} style={{'--share': String(count / most)}}>{count}</span>
        ))}
      </div>
      <figcaption class="dim">{says}</figcaption>
    </figure>
  );
}
