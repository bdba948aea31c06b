// SPDX-License-Identifier: Apache-2.0
// Ruler and rectangle by keys: arrows lead a point over the map, Enter sets the begin and then the end.
import {signal} from '@preact/signals';
import {clamp, type Point, toCanvas} from '../../gl/view';
import {measure} from './hand';
import type {Viewer} from './viewer';

export class Pencil {
  /** In pixels of the map; null: no key has led it yet. */
  readonly at = signal<Point | null>(null);
  private begin: Point | null = null;

  constructor(private readonly viewer: Viewer) {}

  /** By steps of a pixel of the map, from afar of one of the canvas. */
  lead(by: Point): void {
    const map = this.viewer.maps.value?.solve;
    const view = this.viewer.view.value;
    if (!map || !view) return;
    const step = Math.max(1, 1 / view.zoom);
    const now = this.at.value ?? this.middle();
    const to = {x: clamp(now.x + step * by.x, 0, map.width), y: clamp(now.y + step * by.y, 0, map.height)};
    this.at.value = to;
    const canvas = this.viewer.canvas.value;
    const seen = toCanvas(to, view, canvas);
    const isSeen = seen.x >= 0 && seen.y >= 0 && seen.x <= canvas.width && seen.y <= canvas.height;
    if (!isSeen) this.viewer.move(({zoom}) => ({...to, zoom}));
    if (this.begin) measure(this.viewer, this.begin, to);
  }

  set(): void {
    const now = this.at.value ?? this.middle();
    this.at.value = now;
    this.begin = this.begin ? null : now;
    if (this.begin) measure(this.viewer, now, now);
  }

  putAway(): void {
    this.at.value = null;
    this.begin = null;
  }

  /** The middle of a pixel in the middle of the view. */
  private middle(): Point {
    const {x, y} = this.viewer.view.value ?? {x: 0, y: 0};
    return {x: Math.floor(x) + 0.5, y: Math.floor(y) + 0.5};
  }
}
