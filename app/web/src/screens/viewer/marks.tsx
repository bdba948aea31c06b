// SPDX-License-Identifier: Apache-2.0
// What lies over the picture: ruler, rectangle, held pixel, divider, lamp, scale bar.
import {type Repeat, repeats} from '../../gl/tiles';
import {type Point, type Size, type View, toCanvas} from '../../gl/view';
import {clothOf} from '../../state/cloths';
import {fieldsOf, isFields, listIn, numberIn} from '../../ui/fields';
import {scaleBar, zoomInWords} from './bars';
import {placeOf} from './light';
import {type Maps, solveInWords} from './maps';
import type {Viewer} from './viewer';

/** Where the centre of a pixel is on the canvas. */
function centreOf(pixel: Point, view: View, canvas: Size): Point {
  return toCanvas({x: pixel.x + 0.5, y: pixel.y + 0.5}, view, canvas);
}

function Ruler({ends}: {ends: [Point, Point]}) {
  const [a, b] = ends;
  const length = Math.max(1, Math.hypot(b.x - a.x, b.y - a.y));
  const across = {x: (-6 * (b.y - a.y)) / length, y: (6 * (b.x - a.x)) / length};
  const end = (p: Point) => <line x1={p.x - across.x} y1={p.y - across.y} x2={p.x + across.x} y2={p.y + across.y} />;
  return (
    <g class="ruler">
      <line x1={a.x} y1={a.y} x2={b.x} y2={b.y} />
      {end(a)}
      {end(b)}
    </g>
  );
}

function HeldPixel({at, side}: {at: Point; side: number}) {
  const half = Math.max(side, 9) / 2;
  return (
    <g class="held">
      <rect x={at.x - half} y={at.y - half} width={2 * half} height={2 * half} />
      <path d={`M${at.x - half - 8} ${at.y}h6M${at.x + half + 2} ${at.y}h6M${at.x} ${at.y - half - 8}v6M${at.x} ${at.y + half + 2}v6`} />
    </g>
  );
}

function PencilMark({at}: {at: Point}) {
  return <path class="pencil" d={`M${at.x - 14} ${at.y}h10M${at.x + 4} ${at.y}h10M${at.x} ${at.y - 14}v10M${at.x} ${at.y + 4}v10`} />;
}

/** Where the light comes from. Small, since it moves while the picture below it is drawn anew. */
export function LampMark({viewer, density}: {viewer: Viewer; density: number}) {
  if (viewer.tool.value !== 'light') return null;
  const {width, height} = viewer.canvas.value;
  const radius = Math.min(width, height) / 2;
  const place = placeOf(viewer.sight.value.light);
  const x = (width / 2 + place.x * radius) / density;
  const y = (height / 2 + place.y * radius) / density;
  return <div class="lamp-mark" aria-hidden="true" style={{transform: `translate(${x}px, ${y}px)`}} />;
}

/** The borders of a map that is repeated. */
function Seam({map, count, view, canvas}: {map: Size; count: Repeat; view: View; canvas: Size}) {
  return (
    <g class="seam">
      {repeats({size: map}, count).map((offset) => {
        const at = toCanvas(offset, view, canvas);
        return <rect key={`${offset.x},${offset.y}`} x={at.x} y={at.y} width={map.width * view.zoom} height={map.height * view.zoom} />;
      })}
    </g>
  );
}

/** On the cloth before its finish the repeat that was found, by its lengths and its angle, and what was cut. */
function Found({viewer, map, view, canvas}: {viewer: Viewer; map: Maps['solve']; view: View; canvas: Size}) {
  const at = viewer.before.value;
  if (!at) return null;
  const {x, y} = toCanvas(at, view, canvas);
  const found = listIn(map.set, 'steps').map((step) => fieldsOf(fieldsOf(step)['facts'])['repeat']).find(isFields);
  const [ax, ay] = listIn(found, 'across_px') as [number, number];
  const [bx, by] = (found?.['up_px'] ?? [4 * ay, -4 * ax]) as [number, number];
  const from = {x: map.width / 4 - at.x, y: map.height / 2 - at.y};
  const say = (key: string, decimals = 2) => numberIn(found, key)?.toFixed(decimals);
  return (
    <>
      <svg width={viewer.sight.value.divider! * canvas.width} height={canvas.height}>
        <g transform={`translate(${x} ${y}) scale(${view.zoom})`}>
          <polygon points={at.corners.join(' ')} />
          {found && <path d={`M${from.x} ${from.y}l${ax} ${ay}l${bx} ${by}l${-ax} ${-ay}Z`} />}
        </g>
      </svg>
      {found && (
        <text x={x + from.x * view.zoom} y={y + from.y * view.zoom + 20}>
          {say('across_mm')}{found['up_mm'] ? ` × ${say('up_mm')} mm, ${say('angle_deg', 1)}°` : ' mm'}
        </text>
      )}
    </>
  );
}

export function Marks({viewer}: {viewer: Viewer}) {
  const view = viewer.view.value;
  const canvas = viewer.canvas.value;
  const {line, box, pixel, divider, repeat, seam} = viewer.sight.value;
  const map = viewer.maps.value?.solve;
  const mark = viewer.pencil.value?.at;
  const isDivided = divider !== null && (viewer.scene.value?.sides.length ?? 0) > 1;
  const hasSeam = seam && repeat > 1;
  if (!view || !map || !(line || box || pixel || mark || isDivided || hasSeam)) return null;
  const corner = box && toCanvas(box, view, canvas);
  return (
    <svg class="marks" viewBox={`0 0 ${canvas.width} ${canvas.height}`} aria-hidden="true">
      {hasSeam && <Seam map={map} count={repeat} view={view} canvas={canvas} />}
      {box && corner && <rect class="box" x={corner.x} y={corner.y} width={box.width * view.zoom} height={box.height * view.zoom} />}
      {line && <Ruler ends={[centreOf(line[0], view, canvas), centreOf(line[1], view, canvas)]} />}
      {pixel && <HeldPixel at={centreOf(pixel, view, canvas)} side={view.zoom} />}
      {mark && <PencilMark at={toCanvas(mark, view, canvas)} />}
      {isDivided && <Found viewer={viewer} map={map} view={view} canvas={canvas} />}
      {isDivided && <line class="divider" x1={divider * canvas.width} y1={0} x2={divider * canvas.width} y2={canvas.height} />}
    </svg>
  );
}

/** Which solve is on which side of the divider. */
export function SideNames({viewer}: {viewer: Viewer}) {
  const maps = viewer.maps.value;
  const other = viewer.other.value;
  if (!maps || !other || (viewer.scene.value?.sides.length ?? 0) < 2) return null;
  return (
    <div class="side-names">
      <span>{viewer.before.value ? 'before' : nameOf(maps, other)}</span>
      <span>{viewer.before.value ? 'after' : nameOf(other, maps)}</span>
    </div>
  );
}

function nameOf({name, solve}: Maps, beside: Maps): string {
  const what = name.solve === 'truth' ? 'truth' : solveInWords(solve);
  return name.session === beside.name.session ? what : `${clothOf(name.session)}, ${what}`;
}

const MOST_PX = 160;

/** A length on the cloth, true in the middle of the frame. */
export function ScaleBarMark({viewer, density}: {viewer: Viewer; density: number}) {
  const maps = viewer.maps.value;
  const view = viewer.view.value;
  if (!maps || !view) return null;
  const bar = scaleBar(maps.solve.mm_per_pixel, view.zoom, MOST_PX * density);
  return (
    <div class="scale-bar numbers">
      <span class="length" style={{width: `${bar.length / density}px`}} />
      {bar.says} <span class="dim">{zoomInWords(view.zoom)}</span>
    </div>
  );
}
