// SPDX-License-Identifier: Apache-2.0
import {digits} from '../../ui/say';
import {arrowScale, type Coverage} from './photograph_set';

/** Width over height of a part, as calibrate.css has it. */
const aspect = 1.2;

/** Where in the picture corners were seen, as it lies before the eyes, and how far they are from where they should be. */
export function CoverageMap({coverage}: {coverage: Coverage}) {
  const {columns, corners, seen, residuals} = coverage;
  const most = Math.max(1, ...corners);
  const says = `${seen} of ${corners.length} parts of the picture have corners`;
  const hasResiduals = residuals.some(([x, y]) => x !== 0 || y !== 0);
  return (
    <figure class="coverage">
      <div class="cells" role="img" aria-label={says} style={{gridTemplateColumns: `repeat(${columns}, 1fr)`}}>
        {corners.map((count, index) => (
          <span key={index} class={count > 0 ? 'cell' : 'cell none'} style={{'--share': String(count / most)}}>{count}</span>
        ))}
        {hasResiduals && <Arrows coverage={coverage} />}
      </div>
      <figcaption class="dim">
        {says}
        {hasResiduals && `. Arrows: seen less predicted, mean of a part, whose width is ${digits(arrowScale(residuals))} px`}
      </figcaption>
    </figure>
  );
}

/** From the middle of each part. */
function Arrows({coverage: {columns, corners, residuals}}: {coverage: Coverage}) {
  const scale = arrowScale(residuals);
  return (
    <svg class="arrows" viewBox={`0 0 ${columns * aspect} ${corners.length / columns}`} aria-hidden="true">
      {residuals.map(([x, y], index) => {
        const middle = {x: ((index % columns) + 0.5) * aspect, y: Math.floor(index / columns) + 0.5};
        return corners[index] && (
          <g key={index}>
            <circle cx={middle.x} cy={middle.y} r={0.05} />
            <line x1={middle.x} y1={middle.y} x2={middle.x + (x / scale) * aspect} y2={middle.y + (y / scale) * aspect} />
          </g>
        );
      })}
    </svg>
  );
}
