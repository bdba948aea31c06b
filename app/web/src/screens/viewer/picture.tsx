// SPDX-License-Identifier: Apache-2.0
// The picture with all that lies on it.
import {useEffect, useMemo, useRef, useState} from 'preact/hooks';
import type {Point} from '../../gl/view';
import {clothOf} from '../../state/cloths';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {PictureCanvas} from './canvas';
import {Hand} from './hand';
import {saysOf} from './layers';
import {Legend} from './legend';
import {lightInWords} from './light';
import {LampMark, Marks, ScaleBarMark, SideNames} from './marks';
import {Minimap} from './minimap';
import type {Viewer} from './viewer';

const cursors = {move: 'grab', light: 'crosshair', ruler: 'crosshair', region: 'crosshair'};

const keysInWords = 'Keys: 1 to 8 layers, D difference, B divider, L light, R ruler, S rectangle, plus, minus and 0 zoom, arrows move; with ruler or rectangle they lead its end, Shift farther, Enter sets it.';

/** For who cannot see the canvas: which layer it shows, and which keys it has. */
export function labelOf(viewer: Viewer): string {
  const {layer, light} = viewer.sight.value;
  const lit = layer === 'relit' ? ` ${lightInWords(light)}` : '';
  return `${saysOf(layer)}${lit}, ${clothOf(viewer.name.session)}. ${keysInWords}`;
}

/** Pixels of the canvas a pixel of the page. */
function density(): number {
  return Math.min(devicePixelRatio || 1, 2);
}

function useCanvasSize(viewer: Viewer) {
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const element = box.current;
    if (!element) return;
    const measure = () => {
      const {width, height} = element.getBoundingClientRect();
      viewer.canvas.value = {width: Math.round(width * density()), height: Math.round(height * density())};
    };
    const observer = new ResizeObserver(measure);
    observer.observe(element);
    measure();
    return () => observer.disconnect();
  }, [viewer]);
  return box;
}

function useHand(viewer: Viewer) {
  const hand = useMemo(() => new Hand(viewer), [viewer]);
  const placeOf = (event: MouseEvent): Point => {
    const box = (event.currentTarget as Element).getBoundingClientRect();
    return {x: (event.clientX - box.left) * density(), y: (event.clientY - box.top) * density()};
  };
  return {
    onPointerDown: (event: PointerEvent) => {
      if (event.button !== 0) return;
      (event.currentTarget as Element).setPointerCapture(event.pointerId);
      hand.down(event.pointerId, placeOf(event));
    },
    onPointerMove: (event: PointerEvent) => hand.move(event.pointerId, placeOf(event)),
    onPointerUp: (event: PointerEvent) => hand.up(event.pointerId, placeOf(event)),
    onPointerCancel: (event: PointerEvent) => hand.cancel(event.pointerId),
    onWheel: (event: WheelEvent) => {
      event.preventDefault();
      const pixels = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 * event.deltaY : event.deltaY;
      hand.wheel(placeOf(event), pixels);
    },
  };
}

export function Picture({viewer, onCanvas}: {viewer: Viewer; onCanvas: (canvas: PictureCanvas | null) => void}) {
  const box = useCanvasSize(viewer);
  const element = useRef<HTMLCanvasElement>(null);
  const [picture, setPicture] = useState<PictureCanvas | null>(null);
  const hand = useHand(viewer);
  useEffect(() => {
    if (!element.current) return;
    const made = new PictureCanvas(element.current, viewer);
    setPicture(made);
    onCanvas(made);
    return () => {
      made.close();
      onCanvas(null);
    };
  }, [viewer]);

  return (
    <div ref={box} class={`picture ${viewer.tool.value}`}>
      <canvas ref={element} role="application" tabIndex={0} aria-label={labelOf(viewer)}
        style={{cursor: cursors[viewer.tool.value]}} {...hand} />
      <Marks viewer={viewer} />
      <SideNames viewer={viewer} />
      <LampMark viewer={viewer} density={density()} />
      <div class="corner below-left">
        <Legend viewer={viewer} />
        <ScaleBarMark viewer={viewer} density={density()} />
      </div>
      <Minimap viewer={viewer} />
      {picture && <State picture={picture} />}
    </div>
  );
}

/** What is to be known of how the picture is made. */
function State({picture}: {picture: PictureCanvas}) {
  const means = picture.means.value;
  const failure = picture.failure.value;
  return (
    <div class="corner above-left">
      {means === 'pictures' && (
        <p class="remark" role="status">This browser has no WebGL 2: the daemon draws the pictures, a moving light is slower.</p>
      )}
      {means === 'lost' && (
        <p class="remark" role="status">The browser took the graphics away. The picture comes back when it gives them again.</p>
      )}
      {means === 'none' && <p class="remark" role="alert">This browser can draw no pictures here.</p>}
      {failure && (
        <Complaint error={failure}>
          <Button onClick={() => picture.retry()}>Ask again</Button>
        </Complaint>
      )}
    </div>
  );
}
