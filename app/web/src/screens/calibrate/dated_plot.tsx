// SPDX-License-Identifier: Apache-2.0
import {Axes} from '../../ui/axes';
import {linearScale} from '../../ui/plot_scale';
import {digits} from '../../ui/say';
import {sideBySide, type Dated, type Label, type Series} from './history';
import type {CheckResult} from './walk';

interface DatedPlotProps {
  title: string;
  unit: string;
  /** What is smaller says nothing. */
  leastSpan: number;
  series: readonly Series[];
  checks: readonly CheckResult[];
}

const minute_ms = 60_000;
const units = [
  {unit: 'days', ms: 24 * 60 * minute_ms},
  {unit: 'hours', ms: 60 * minute_ms},
  {unit: 'minutes', ms: minute_ms},
] as const;
const height_px = 210;
const checks_px = 166;

/** The largest of which the time has at least two. */
function unitOf(span_ms: number): (typeof units)[number] {
  return units.find(({ms}) => span_ms >= 2 * ms) ?? units[2];
}

/** What was measured over time, from its second measurement on, and below it when the calibration was checked. */
export function DatedPlot({title, unit, leastSpan, series, checks}: DatedPlotProps) {
  if (series.every(({points}) => points.length < 2)) return null;
  const points = series.flatMap((each) => each.points);
  const dated = checks.map((check) => ({...check, time_ms: Date.parse(check.date)}));
  const times_ms = [...points, ...dated].map((each) => each.time_ms);
  const begin_ms = Math.min(...times_ms);
  const {unit: timeUnit, ms} = unitOf(Math.max(...times_ms) - begin_ms);
  const since = (time_ms: number) => (time_ms - begin_ms) / ms;
  const x = {scale: linearScale(times_ms.map(since)), label: timeUnit, say: String};
  const y = {scale: linearScale(points.map((each) => each.value), leastSpan), label: unit, say: String};
  return (
    <figure class="dated">
      <figcaption>{title}</figcaption>
      <Axes title={title} x={x} y={y} width={440} height={height_px}>
        {(placeX, placeY) => (
          <>
            {series.map((each) => (
              <Line key={each.name} series={each} unit={unit} x={(point) => placeX(since(point.time_ms))}
                y={(point) => placeY(point.value)} />
            ))}
            {namesOf(series, (point) => placeX(since(point.time_ms)), (point) => placeY(point.value)).map(({text, x, y}) => (
              <text key={text} class="series" x={x + 6} y={y + 4}>{text}</text>
            ))}
            {dated.map((check) => (
              <text key={check.folder} class={check.passed ? 'check' : 'check failed'} x={placeX(since(check.time_ms))}
                y={checks_px} text-anchor="middle">
                {check.passed ? '●' : '▲'}
                <title>{`${check.folder}: ${check.passed ? 'passed' : `found ${check.found}`}`}</title>
              </text>
            ))}
          </>
        )}
      </Axes>
    </figure>
  );
}

type Place = (point: Dated) => number;

/** Each at the end of its line. */
function namesOf(series: readonly Series[], x: Place, y: Place): Label[] {
  return sideBySide(series.flatMap(({name, points}) => points.slice(-1).map((last) => ({text: name.replace('LED ', ''), x: x(last), y: y(last)}))));
}

interface LineProps {
  series: Series;
  unit: string;
  x: Place;
  y: Place;
}

function Line({series: {name, points}, unit, x, y}: LineProps) {
  return (
    <g>
      <polyline class="line" points={points.map((point) => `${x(point)},${y(point)}`).join(' ')} />
      {points.map((point) => (
        <circle key={point.time_ms} class="point" cx={x(point)} cy={y(point)} r={3}>
          <title>{`${name} ${digits(point.value, 4)} ${unit}`}</title>
        </circle>
      ))}
    </g>
  );
}
