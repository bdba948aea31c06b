// SPDX-License-Identifier: Apache-2.0
// One line of words for what the canvas shows and for the pixel that is asked about.
import {zoomInWords} from './bars';
import {saysOf} from './layers';
import {lightInWords} from './light';
import {valuesOf} from './probe';
import type {Point} from '../../gl/view';
import type {Viewer} from './viewer';

function pixelAt(point: Point): Point {
  return {x: Math.floor(point.x), y: Math.floor(point.y)};
}

export function StatusLine({viewer}: {viewer: Viewer}) {
  const {layer, light, exposure} = viewer.sight.value;
  const view = viewer.view.value;
  const pixel = viewer.pixel.value;
  const pencil = viewer.pencil.value;
  const mark = pencil && pixelAt(pencil.at);
  const lit = layer === 'relit' ? ` ${lightInWords(light)}` : '';
  const brighter = exposure === 0 ? '' : `, ${exposure > 0 ? '+' : ''}${exposure.toFixed(1)} stops`;
  const numbers = (name: string) => (pixel ? valuesOf(pixel, name).map((value) => Number(value).toFixed(3)).join(' ') : '');
  return (
    <div class="status-line numbers">
      <span role="status">{saysOf(layer)}{lit}{brighter}{view && `, ${zoomInWords(view.zoom)}`}{mark && `, mark at ${mark.x}, ${mark.y}`}</span>
      {pixel && (
        <span>
          {pixel.x}, {pixel.y} <span class="dim">normal</span> {numbers('normal')} <span class="dim">albedo</span> {numbers('albedo')}
        </span>
      )}
    </div>
  );
}
