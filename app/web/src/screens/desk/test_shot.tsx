// SPDX-License-Identifier: Apache-2.0
// A photograph that nobody keeps: how it is exposed, and how sharp it is among those before it.
import {useState} from 'preact/hooks';
import type {Schemas} from '../../api/client';
import type {Point} from '../../gl/view';
import {Button} from '../../ui/button';
import {Complaint} from '../../ui/complaint';
import {Mark} from '../../ui/mark';
import {percentOf} from '../../ui/words';
import {exposedOf} from './clipping';
import {say} from './cloth';
import {shots} from './devices';
import {exposureInWords, millisecondsOf} from './exposure';
import {aspectOf} from './live_view';
import {Loupe} from './loupe';

type TestShot = Schemas['TestShot'];
type Focus = NonNullable<TestShot['focus']>;

function shadeOf(relative: number | null): string {
  return relative === null ? 'unknown' : relative > 0.97 ? 'sharpest' : relative > 0.85 ? 'close' : 'soft';
}

/** By part of the picture: how sharp, of the sharpest that it was, in percent. */
function FocusMap({focus}: {focus: Focus}) {
  const rows = focus.columns > 0 ? Math.ceil(focus.relative.length / focus.columns) : 0;
  return (
    <div class="focus-map" role="img" aria-label={focusInWords(focus)} style={{gridTemplateColumns: `repeat(${focus.columns}, 1fr)`, gridTemplateRows: `repeat(${rows}, 1fr)`}}>
      {focus.relative.map((relative, at) => (
        <span key={at} class={shadeOf(relative)}>{relative === null ? '–' : Math.round(relative * 100)}</span>
      ))}
    </div>
  );
}

/** The scores of these shots, one after another, with the sharpest marked. */
function FocusCurve({focus}: {focus: Focus}) {
  const known = focus.scores.filter((score) => score !== null);
  if (known.length < 2) return null;
  const most = Math.max(...known);
  const at = (index: number) => `${(index / (focus.scores.length - 1)) * 100},${30 - ((focus.scores[index] ?? 0) / most) * 28}`;
  const [bestX, bestY] = at(focus.best).split(',');
  return (
    <svg class="focus-curve" viewBox="-3 -3 106 36" role="img" aria-label="Sharpness, shot after shot">
      <polyline points={focus.scores.map((_, index) => at(index)).join(' ')} />
      <circle cx={bestX} cy={bestY} r={2.5} />
    </svg>
  );
}

function slopeInWords(more: number | null, one: string, other: string): string {
  if (more === null || Math.abs(more) < 0.03) return '';
  return ` The ${more > 0 ? one : other} is sharper by ${percentOf(Math.abs(more))}.`;
}

export function focusInWords(focus: Focus): string {
  const newest = focus.scores.at(-1);
  const best = focus.scores[focus.best];
  if (newest == null || best == null) return 'Too dark or too full to tell how sharp it is.';
  const count = focus.scores.length;
  const standing = count === 1 ? 'The first of its kind: turn the ring and shoot again.'
    : focus.best === count - 1 ? `The sharpest of ${count}.`
    : `${percentOf(newest / best)} of the sharpest, shot ${focus.best + 1} of ${count}.`;
  return standing + slopeInWords(focus.more_right, 'right', 'left') + slopeInWords(focus.more_below, 'lower edge', 'upper edge');
}

const step = 0.02;
const steps: Record<string, Point> = {
  ArrowLeft: {x: -step, y: 0}, ArrowRight: {x: step, y: 0}, ArrowUp: {x: 0, y: -step}, ArrowDown: {x: 0, y: step},
};

function clamp(share: number): number {
  return Math.min(Math.max(share, 0), 1);
}

/** The whole shot, on which a place is pointed at, by arrow keys too. */
function Overview({shot, onPlace, place}: {shot: TestShot; place: Point; onPlace: (place: Point) => void}) {
  const point = (event: PointerEvent) => {
    const {left, top, width, height} = (event.currentTarget as Element).getBoundingClientRect();
    onPlace({x: clamp((event.clientX - left) / width), y: clamp((event.clientY - top) / height)});
  };
  const press = (event: KeyboardEvent) => {
    const by = steps[event.key];
    if (!by) return;
    event.preventDefault();
    onPlace({x: clamp(place.x + by.x), y: clamp(place.y + by.y)});
  };
  return (
    <figure class="overview sheet" style={aspectOf(shot)} tabIndex={0} role="group" aria-label="Test shot: point at a place, or move by arrow keys" onPointerMove={point} onKeyDown={press}>
      <img src={`/api/v1/rig/test-shots/${shot.id}/picture`} alt={`Test shot ${shot.id}`} />
      {shot.focus && <FocusMap focus={shot.focus} />}
    </figure>
  );
}

/** The exposure that a scan of this cloth would be given. */
function Suggested({shot}: {shot: TestShot}) {
  const suggested = shot.suggested_us;
  if (suggested === null) return null;
  return (
    <p class="row">
      <span>A scan would expose {exposureInWords(suggested)}.</span>
      <Button onClick={() => say({exposure_ms: millisecondsOf(suggested)})}>Use that</Button>
    </p>
  );
}

const channels = ['red', 'green', 'blue'] as const;

function outlineOf(bins: readonly number[]): string {
  const most = Math.log1p(Math.max(1, ...bins));
  return bins.map((count, bin) => `${bin},${(1 - Math.log1p(count) / most).toFixed(3)}`).join(' ');
}

/** Counts by channel from black to white, on a logarithmic scale. */
function HistogramPlot({of, label}: {of: Schemas['Histogram']; label: string}) {
  return (
    <svg class="histogram" viewBox="0 0 63 1" preserveAspectRatio="none" role="img" aria-label={label}>
      {channels.map((channel) => <polyline key={channel} class={channel} points={outlineOf(of[channel].bins)} />)}
    </svg>
  );
}

function Facts({shot}: {shot: TestShot}) {
  const histogram = shot.histogram as Schemas['Histogram'] | null;
  const exposed = histogram && exposedOf(histogram);
  return (
    <div class="facts">
      <h2>{shot.led === 0 ? 'Without a LED' : `LED ${shot.led}`}, {exposureInWords(shot.exposure_us)}</h2>
      {exposed && (
        <p>
          <Mark verdict={exposed.verdict}>{exposed.word}</Mark>, {percentOf(exposed.clipped)} clipped
          {exposed.headroom_stops !== null && `, ${exposed.headroom_stops.toFixed(1)} stops of room`}
        </p>
      )}
      {histogram && <HistogramPlot of={histogram} label={`Histogram of test shot ${shot.id}`} />}
      <Suggested shot={shot} />
      {shot.focus && <p>{focusInWords(shot.focus)}</p>}
      {shot.focus && <FocusCurve focus={shot.focus} />}
    </div>
  );
}

export function TestShotView() {
  const [place, setPlace] = useState<Point>({x: 0.5, y: 0.5});
  const shot = shots.value.at(-1);
  if (!shot) return null;
  if (shot.error) return <Complaint error={shot.error} />;
  if (shot.state !== 'taken') return <p class="waits">Taking it</p>;
  return (
    <div class="test-shot">
      <Overview shot={shot} place={place} onPlace={setPlace} />
      <Facts shot={shot} />
      <Loupe shot={shot} place={place} />
    </div>
  );
}
