// SPDX-License-Identifier: Apache-2.0
import type {ComponentChildren} from 'preact';
import './axes.css';
import type {Scale} from './plot_scale';

interface Axis {
  scale: Scale;
  label: string;
  say: (value: number) => string;
}

interface AxesProps {
  /** What is plotted, for who hears it read. */
  title: string;
  x: Axis;
  y: Axis;
  width?: number;
  height?: number;
  /** Draws at the places of values. */
  children: (x: (value: number) => number, y: (value: number) => number) => ComponentChildren;
}

const margin = {left: 58, right: 16, top: 12, bottom: 40};

/** The frame of a plot: two axes with what is written beside them. */
export function Axes({title, x, y, width = 640, height = 320, children}: AxesProps) {
  const right = width - margin.right;
  const bottom = height - margin.bottom;
  const placeX = (value: number) => margin.left + x.scale.place(value) * (right - margin.left);
  const placeY = (value: number) => bottom - y.scale.place(value) * (bottom - margin.top);
  return (
    <svg class="axes" viewBox={`0 0 ${width} ${height}`} role="group" aria-label={title}>
      <g aria-hidden="true">
        {x.scale.ticks.map((tick) => (
          <g key={tick}>
            <line class="grid" x1={placeX(tick)} x2={placeX(tick)} y1={margin.top} y2={bottom} />
            <text x={placeX(tick)} y={bottom + 16} text-anchor="middle">{x.say(tick)}</text>
          </g>
        ))}
        {y.scale.ticks.map((tick) => (
          <g key={tick}>
            <line class="grid" x1={margin.left} x2={right} y1={placeY(tick)} y2={placeY(tick)} />
            <text x={margin.left - 7} y={placeY(tick) + 4} text-anchor="end">{y.say(tick)}</text>
          </g>
        ))}
        <text class="name" x={right} y={height - 6} text-anchor="end">{x.label}</text>
        <text class="name" x={-margin.top} y={12} transform="rotate(-90)" text-anchor="end">{y.label}</text>
      </g>
      {children(placeX, placeY)}
    </svg>
  );
}
