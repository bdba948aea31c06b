// SPDX-License-Identifier: Apache-2.0
import {heatColour, type Rgb} from '../../gl/heat';
import {hasScale, saysOf, unitOf} from './layers';
import type {Viewer} from './viewer';

export function cssColour(colour: Rgb): string {
  return `rgb(${colour.map((value) => Math.round(255 * value)).join(' ')})`;
}

const stops = [...Array(17).keys()].map((i) => i / 16);

/** The scale of colours with its ends and unit. */
export function Legend({viewer}: {viewer: Viewer}) {
  const maps = viewer.maps.value;
  const {layer} = viewer.sight.value;
  if (!maps || !hasScale(maps.solve, layer)) return null;
  const [least, most] = viewer.range.value;
  const short = (value: number) => String(Number(value.toPrecision(3)));
  return (
    <figure class="legend">
      <figcaption>{[saysOf(layer), unitOf(maps.solve, layer)].filter((word) => word !== '').join(', ')}</figcaption>
      <svg viewBox="0 0 160 10" aria-hidden="true">
        <linearGradient id="heat">
          {stops.map((share) => <stop key={share} offset={share} stop-color={cssColour(heatColour(share))} />)}
        </linearGradient>
        <rect width="160" height="10" fill="url(#heat)" />
      </svg>
      <div class="ends numbers"><span>{short(least)}</span><span>{short((least + most) / 2)}</span><span>{short(most)}</span></div>
    </figure>
  );
}
