// SPDX-License-Identifier: Apache-2.0
// The material on its canvas, with a bar that says how large it is and a lamp that is dragged.
import {effect} from '@preact/signals';
import {useEffect, useRef, useState} from 'preact/hooks';
import {asApiError} from '../../api/client';
import {ClothSurface} from '../../gl/cloth_surface';
import {useKeys} from '../../state/keys';
import {lengthInWords, roundBelow} from '../viewer/bars';
import {lightAt, lightInWords, nudged, placeOf} from '../viewer/light';
import type {Look} from './look';
import type {Shape} from './material_sight';
import {titleOf} from './title';

const BAR_PX = 160;
const STEP = 0.05;

function density(): number {
  return Math.min(devicePixelRatio || 1, 2);
}

const shapesInWords: Record<Shape, string> = {ball: 'on a ball', plane: 'laid flat', true: 'at its true size'};

/** Fetches what a canvas shows, and draws it whenever something of it changes; what ends that. */
function follow(element: HTMLCanvasElement, look: Look, tell: (means: 'webgl' | 'lost' | 'none') => void): () => void {
  let surface: ClothSurface | null = null;
  let request = new AbortController();
  let isLoaded = false;
  let frame = 0;
  const draw = () => {
    cancelAnimationFrame(frame);
    element.dataset.ready = 'false';
    const drawn = look.drawn(density());
    if (!surface || !isLoaded || !drawn) return;
    frame = requestAnimationFrame(() => {
      surface?.draw(drawn);
      element.dataset.ready = 'true';
    });
  };
  const load = () => {
    const maps = look.maps.value;
    request.abort();
    isLoaded = false;
    if (!surface || !maps) return;
    request = new AbortController();
    const {signal} = request;
    surface.load(maps, signal).then(
      () => {
        isLoaded = !signal.aborted;
        draw();
      },
      (error: unknown) => {
        if (!signal.aborted) look.complaint.value = asApiError(error);
      },
    );
  };
  const begin = () => {
    surface = ClothSurface.on(element);
    tell(surface ? 'webgl' : 'none');
  };
  const restore = () => {
    begin();
    load();
  };
  const lose = (event: Event) => {
    event.preventDefault();
    request.abort();
    surface = null;
    tell('lost');
  };
  element.addEventListener('webglcontextlost', lose);
  element.addEventListener('webglcontextrestored', restore);
  begin();
  const ends = [effect(load), effect(draw)];
  return () => {
    ends.forEach((end) => end());
    request.abort();
    cancelAnimationFrame(frame);
    surface?.close();
    element.removeEventListener('webglcontextlost', lose);
    element.removeEventListener('webglcontextrestored', restore);
  };
}

export function Stage({look}: {look: Look}) {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [means, setMeans] = useState('webgl');
  useEffect(() => {
    const element = box.current;
    if (!element) return undefined;
    const measure = () => {
      const {width, height} = element.getBoundingClientRect();
      look.canvas.value = {width: Math.round(width), height: Math.round(height)};
    };
    const observer = new ResizeObserver(measure);
    observer.observe(element);
    measure();
    return () => observer.disconnect();
  }, [look]);
  useEffect(() => (canvas.current ? follow(canvas.current, look, setMeans) : undefined), [look]);
  useLightKeys(look);
  const {light, shape} = look.sight.value;
  return (
    <div ref={box} class="picture">
      <canvas ref={canvas} role="application" tabIndex={0} {...handOf(look)}
        aria-label={`${titleOf(look.name)} ${shapesInWords[shape]}, lit ${lightInWords(light)}. Arrows move the lamp.`} />
      <Lamp look={look} />
      <Bar look={look} />
      {means === 'none' && <p class="remark" role="alert">This browser has no WebGL 2, which the material is drawn by. The viewer shows its maps without it.</p>}
      {means === 'lost' && <p class="remark" role="status">The browser took the graphics away. The picture comes back when it gives them again.</p>}
      {look.cloth.value?.is_known === false && <p class="remark" role="status">Nobody knows how many millimetres it is wide.</p>}
    </div>
  );
}

function useLightKeys(look: Look): void {
  const move = (x: number, y: number) => () => look.see({light: nudged(look.sight.peek().light, {x, y})});
  useKeys('material', [
    {key: 'ArrowLeft', does: 'lamp to the left', run: move(-STEP, 0)},
    {key: 'ArrowRight', does: 'lamp to the right', run: move(STEP, 0)},
    {key: 'ArrowUp', does: 'lamp up', run: move(0, -STEP)},
    {key: 'ArrowDown', does: 'lamp down', run: move(0, STEP)},
    {key: 'b', does: 'on a ball', run: () => look.see({shape: 'ball'})},
    {key: 'p', does: 'laid flat', run: () => look.see({shape: 'plane'})},
    {key: 't', does: 'at its true size', run: () => look.see({shape: 'true'})},
  ]);
}

/** The lamp is where the hand is, the middle of the picture being straight above. */
function handOf(look: Look) {
  const shine = (event: PointerEvent) => {
    const element = event.currentTarget as Element;
    if (!element.hasPointerCapture(event.pointerId)) return;
    const {left, top, width, height} = element.getBoundingClientRect();
    const half = Math.min(width, height) / 2;
    look.see({light: lightAt({x: (event.clientX - left - width / 2) / half, y: (event.clientY - top - height / 2) / half})});
  };
  const end = () => (look.isMoving.value = false);
  return {
    onPointerDown: (event: PointerEvent) => {
      if (event.button !== 0) return;
      (event.currentTarget as Element).setPointerCapture(event.pointerId);
      look.isMoving.value = true;
      shine(event);
    },
    onPointerMove: shine,
    onPointerUp: end,
    onPointerCancel: end,
  };
}

function Lamp({look}: {look: Look}) {
  const {width, height} = look.canvas.value;
  const at = placeOf(look.sight.value.light);
  const half = Math.min(width, height) / 2;
  return <span class="lamp-mark" style={{transform: `translate(${width / 2 + half * at.x}px, ${height / 2 + half * at.y}px)`}} />;
}

/** At true size a centimetre, else the longest round length that there is room for. */
function Bar({look}: {look: Look}) {
  const laid = look.laid.value;
  if (!laid || !look.cloth.value?.is_known) return null;
  const mm = look.sight.value.shape === 'true' ? 10 : roundBelow(BAR_PX / laid.px_per_mm);
  return (
    <div class="scale-bar numbers">
      <span class="length" data-mm={mm} style={{width: `${mm * laid.px_per_mm}px`}} />
      {lengthInWords(mm)} {laid.radius_mm > 0 && <span class="dim">in the middle</span>}
    </div>
  );
}
