// SPDX-License-Identifier: Apache-2.0
import {clamp, toMap} from '../../gl/view';
import {addressOfMaps} from './maps';
import type {Viewer} from './viewer';

const MOST_PX = 150;

/** The whole map with the part that is seen, while it is a part. A click goes there. */
export function Minimap({viewer}: {viewer: Viewer}) {
  const maps = viewer.maps.value;
  const view = viewer.view.value;
  if (!maps || !view) return null;
  const {width, height, layers} = maps.solve;
  const canvas = viewer.canvas.value;
  const from = toMap({x: 0, y: 0}, view, canvas);
  const to = toMap({x: canvas.width, y: canvas.height}, view, canvas);
  const isWhole = from.x <= 1 && from.y <= 1 && to.x >= width - 1 && to.y >= height - 1;
  if (isWhole || viewer.sight.value.repeat > 1) return null;
  const each = MOST_PX / Math.max(width, height);
  const across = Math.round(width * each);
  const down = Math.round(height * each);
  const left = clamp(from.x, 0, width);
  const top = clamp(from.y, 0, height);
  const layer = layers.some(({name}) => name === 'albedo') ? 'albedo' : 'normal';
  const goThere = (event: MouseEvent) => {
    const box = (event.currentTarget as Element).getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * width;
    const y = ((event.clientY - box.top) / box.height) * height;
    viewer.move((now) => ({...now, x, y}));
  };
  return (
    <div class="minimap" style={{width: `${across}px`, height: `${down}px`}} onClick={goThere}>
      <img alt="The whole map" width={across} height={down}
        src={`${addressOfMaps(maps.name)}/tiles/${layer}/top/0_0.png`} />
      <svg viewBox={`0 0 ${width} ${height}`} aria-hidden="true">
        <rect x={left} y={top} width={clamp(to.x, 0, width) - left} height={clamp(to.y, 0, height) - top} />
      </svg>
    </div>
  );
}
