// SPDX-License-Identifier: Apache-2.0
// Accuracy against time: each level as a point, and its error's parts as small marks below it.
import type {Quality} from '../../state/forms';
import {Axes} from '../../ui/axes';
import {lanesOf, logScale} from '../../ui/plot_scale';
import {degreesOn} from '../../ui/say';
import {durationOf} from '../../ui/words';
import type {Level} from './ladder';

interface LadderPlotProps {
  levels: readonly Level[];
  /** Those worth their time are joined. */
  worthwhile: readonly Level[];
  onChoose: (quality: Quality) => void;
}

const partMarks = {noise: '○', model: '△', calibration: '□'} as const;
type PartName = keyof typeof partMarks;
const partNames = Object.keys(partMarks) as PartName[];
/** A part with a smaller share of the error says nothing of it, and would stretch the axis. */
const leastShare = 0.02;
const nameWidth_px = 74;
const lane_px = 15;

function drawnParts(level: Level): PartName[] {
  return partNames.filter((part) => level.parts_deg[part] > leastShare * level.predicted_deg);
}

export function LadderPlot({levels, worthwhile, onChoose}: LadderPlotProps) {
  const x = {scale: logScale(levels.map((level) => level.seconds)), label: 'seconds on this machine', say: String};
  const y = {
    scale: logScale(levels.flatMap((level) => [level.predicted_deg, ...drawnParts(level).map((part) => level.parts_deg[part])])),
    label: 'predicted error of normals, degrees',
    say: String,
  };
  return (
    <figure class="ladder">
      <Axes title="Accuracy against time" x={x} y={y} height={360}>
        {(placeX, placeY) => {
          const xOf = (level: Level) => placeX(level.seconds);
          const yOf = (level: Level) => placeY(level.predicted_deg);
          const lanes = lanesOf(levels, xOf, nameWidth_px);
          const namesFrom = (level: Level) => {
            const lane = lanes.get(level) ?? 0;
            const beside = levels.filter((other) => Math.abs(xOf(other) - xOf(level)) < nameWidth_px);
            return lane === 0 ? yOf(level) : Math.min(...beside.map(yOf)) - lane_px * lane;
          };
          return <>
            <polyline class="line" points={pointsOf(worthwhile, placeX, placeY)} />
            {levels.map((level) => (
              <LevelPoint key={level.quality} level={level} x={xOf(level)} placeY={placeY}
                nameFrom={namesFrom(level)} isWorthwhile={worthwhile.includes(level)} onChoose={onChoose} />
            ))}
          </>;
        }}
      </Axes>
      <figcaption class="dim">
        ● the whole error; of it, where it matters, {partNames.map((part) => `${partMarks[part]} ${part}`).join(', ')}.
        The line joins the levels that nothing cheaper equals. Press a level to queue it.
      </figcaption>
    </figure>
  );
}

function pointsOf(levels: readonly Level[], x: (value: number) => number, y: (value: number) => number): string {
  const ordered = [...levels].sort((a, b) => a.seconds - b.seconds);
  return ordered.map((level) => `${x(level.seconds)},${y(level.predicted_deg)}`).join(' ');
}

interface LevelPointProps {
  level: Level;
  x: number;
  placeY: (value: number) => number;
  /** Its name stands above this: at its point, or lifted over those beside it. */
  nameFrom: number;
  isWorthwhile: boolean;
  onChoose: (quality: Quality) => void;
}

function LevelPoint({level, x, placeY, nameFrom, isWorthwhile, onChoose}: LevelPointProps) {
  const y = placeY(level.predicted_deg);
  const choose = () => onChoose(level.quality);
  const press = (event: KeyboardEvent) => {
    if (event.key !== 'Enter' && event.key !== ' ') return;
    event.preventDefault();
    choose();
  };
  const says = `${level.quality}: ${durationOf(level.seconds)}, ${degreesOn(level.predicted_deg, level.solved)}. Queue it`;
  return (
    <g class="level" role="button" tabIndex={0} aria-label={says} onClick={choose} onKeyDown={press}>
      {drawnParts(level).map((part) => (
        <text key={part} class="part" x={x} y={placeY(level.parts_deg[part]) + 4} text-anchor="middle">{partMarks[part]}</text>
      ))}
      <circle class="target" cx={x} cy={y} r={20} />
      <circle class={isWorthwhile ? 'dot' : 'dot idle'} cx={x} cy={y} r={6} />
      {nameFrom < y && <line class="leader" x1={x} x2={x} y1={y - 8} y2={nameFrom - 11} />}
      <text class="name" x={x} y={nameFrom - 13} text-anchor="middle">{level.quality}</text>
    </g>
  );
}
