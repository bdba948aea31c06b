// SPDX-License-Identifier: Apache-2.0
// A swatch under a light that follows the pointer.
import {computed, signal} from '@preact/signals';
import {useEffect, useMemo, useRef, useState} from 'preact/hooks';
import type {Scene} from '../../gl/scene';
import {PictureCanvas} from './canvas';
import {lightAt} from './light';
import {loadMaps, type Maps, sideOf} from './maps';
import {FIRST_SIGHT, type SolveName} from './sight';

const SIDE_PX = 640;
/** What lies flat is as bright as its albedo under the first light. */
const STOPS = 0.5;

function shownOf(maps: Maps) {
  const light = signal(FIRST_SIGHT.light);
  const side = sideOf(maps, 'relit', [], null);
  const {x, y, side: wide} = maps.solve.swatch;
  const scene = computed<Scene | null>(() => side && {
    view: {x: x + wide / 2, y: y + wide / 2, zoom: SIDE_PX / wide},
    bits: {names: [], colours: []},
    sides: [side],
    divider: 1,
    look: {light: light.value, exposure: STOPS, range: [0, 1]},
    repeat: 1,
    is_moving: false,
  });
  return {light, scene, canvas: signal({width: SIDE_PX, height: SIDE_PX}), isComing: signal(false)};
}

export function RelitCloth({name, says}: {name: SolveName; says: string}) {
  const [maps, setMaps] = useState<Maps | null>(null);
  const element = useRef<HTMLCanvasElement>(null);
  const shown = useMemo(() => maps && shownOf(maps), [maps]);
  useEffect(() => {
    loadMaps(name).then(setMaps, () => {});
  }, []);
  useEffect(() => {
    if (!element.current || !shown) return undefined;
    const picture = new PictureCanvas(element.current, shown);
    const follow = ({clientX, clientY}: PointerEvent) => {
      const {left, top, width} = picture.element.getBoundingClientRect();
      shown.light.value = lightAt({x: (2 * (clientX - left)) / width - 1, y: (2 * (clientY - top)) / width - 1});
    };
    addEventListener('pointermove', follow);
    return () => {
      removeEventListener('pointermove', follow);
      picture.close();
    };
  }, [shown]);
  return <canvas ref={element} class="relit" role="img" aria-label={`${says}, under a light that follows the pointer`} />;
}
