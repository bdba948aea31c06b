// SPDX-License-Identifier: Apache-2.0
import {heatColour} from '../gl/heat';

interface FrameMap {
  columns: number;
  /** Row by row from the upper left, null where there is none. */
  values: (number | null)[];
  unit: string;
  least: number;
  most: number;
}

interface Arrows {
  width: number;
  height: number;
  /** Where each begins, and from there to its tip. */
  all: [x: number, y: number, dx: number, dy: number][];
  magnification: number;
}

export type FigureData = {label: string} & ({svg: string} | {png: string} | {map: FrameMap} | {arrows: Arrows});

export function Figure(figure: FigureData) {
  return (
    <figure>
      {'svg' in figure && <div dangerouslySetInnerHTML={{__html: figure.svg}} />}
      {'png' in figure && <img alt={figure.label} src={`data:image/png;base64,${figure.png}`} />}
      {'map' in figure && <MapOfFrame {...figure.map} />}
      {'arrows' in figure && <ArrowsInFrame {...figure.arrows} />}
      {figure.label && <figcaption>{figure.label}</figcaption>}
    </figure>
  );
}

const scaleSteps = 40;

function colourOf(share: number): string {
  return `rgb(${heatColour(share).map((value) => Math.round(255 * value)).join()})`;
}

/** Three digits that matter. */
function threeDigits(value: number): number {
  return Number(value.toPrecision(3));
}

/** Values as coloured squares, and their scale. */
function MapOfFrame({columns, values, unit, least, most}: FrameMap) {
  const width = 10 * columns;
  const bottom = (10 * values.length) / columns;
  return (
    <svg class="map" viewBox={`0 0 ${width} ${bottom + 30}`} role="img">
      {values.map((value, i) => (
        <rect key={i} x={10 * (i % columns)} y={10 * Math.floor(i / columns)} width={10.3} height={10.3}
          fill={value === null ? '#fff' : colourOf((value - least) / (most - least))} />
      ))}
      {Array.from({length: scaleSteps}, (_, i) => (
        <rect key={i} x={(width * i) / scaleSteps} y={bottom + 6} width={width / scaleSteps + 0.3} height={8}
          fill={colourOf((i + 0.5) / scaleSteps)} />
      ))}
      <text y={bottom + 26}>{threeDigits(least)}</text>
      <text x={width} y={bottom + 26} text-anchor="end">{threeDigits(most)} {unit}</text>
    </svg>
  );
}

function ArrowsInFrame({width, height, all, magnification}: Arrows) {
  const scale = 640 / width;
  const bottom = height * scale;
  return (
    <svg class="arrows" viewBox={`0 0 640 ${bottom + 20}`} role="img">
      <rect width={640} height={bottom} />
      {all.map(([x, y, dx, dy], i) => (
        <g key={i} transform={`translate(${x * scale} ${y * scale})`}>
          <circle r={1.4} />
          <line x2={dx * scale * magnification} y2={dy * scale * magnification} />
        </g>
      ))}
      <text x={4} y={bottom + 15}>arrows {magnification} times as long as they are</text>
    </svg>
  );
}
