// SPDX-License-Identifier: Apache-2.0
// What pointers on the picture do, by the tool that is chosen. Places are pixels of the canvas.
import {lightAt} from './light';
import {type Box, type Point, type Size, type View, clamp, panned, toMap, zoomed} from '../../gl/view';
import type {Viewer} from './viewer';

/** A pointer that moves less than this was a click. */
const CLICK_PX = 4;

/** How near to the divider a pointer takes it. */
const DIVIDER_PX = 10;

/** Ends of a line are between centres of pixels, of which the first is (0, 0). */
function centre(point: Point, map: Size): Point {
  return {x: clamp(point.x - 0.5, 0, map.width - 1), y: clamp(point.y - 0.5, 0, map.height - 1)};
}

/** Whole pixels from one corner to the other, both within the map. */
export function boxBetween(a: Point, b: Point, map: Size): Box {
  const pixel = (point: Point) => ({
    x: clamp(Math.floor(point.x), 0, map.width - 1),
    y: clamp(Math.floor(point.y), 0, map.height - 1),
  });
  const from = pixel(a);
  const to = pixel(b);
  return {
    x: Math.min(from.x, to.x),
    y: Math.min(from.y, to.y),
    width: Math.abs(to.x - from.x) + 1,
    height: Math.abs(to.y - from.y) + 1,
  };
}

/** Lays the ruler or the rectangle, whichever is chosen, from one point of the map to another. */
export function measure(viewer: Viewer, from: Point, to: Point): void {
  const map = viewer.maps.value?.solve;
  if (!map) return;
  if (viewer.tool.value === 'ruler') viewer.see({line: [centre(from, map), centre(to, map)]});
  else viewer.see({box: boxBetween(from, to, map)});
}

/** Where a place is on the largest disc of the canvas. */
export function onDisc(at: Point, canvas: Size): Point {
  const radius = Math.min(canvas.width, canvas.height) / 2;
  return {x: (at.x - canvas.width / 2) / radius, y: (at.y - canvas.height / 2) / radius};
}

/** The view that two fingers make which were at `before` and are at `now`. */
export function pinched(view: View, before: [Point, Point], now: [Point, Point], canvas: Size): View {
  const middle = ([a, b]: [Point, Point]) => ({x: (a.x + b.x) / 2, y: (a.y + b.y) / 2});
  const apart = ([a, b]: [Point, Point]) => Math.max(1, Math.hypot(a.x - b.x, a.y - b.y));
  const from = middle(before);
  const to = middle(now);
  const moved = panned(view, {x: to.x - from.x, y: to.y - from.y});
  return zoomed(moved, apart(now) / apart(before), to, canvas);
}

export class Hand {
  private readonly pointers = new Map<number, Point>();
  private begin: Point | null = null;
  private isClick = false;
  private holdsDivider = false;

  constructor(private readonly viewer: Viewer) {}

  down(id: number, at: Point): void {
    this.pointers.set(id, at);
    this.begin = at;
    this.holdsDivider = this.pointers.size === 1 && this.isOnDivider(at);
    this.isClick = this.pointers.size === 1 && !this.holdsDivider;
    if (this.viewer.tool.value === 'light' && !this.holdsDivider) this.shine(at);
  }

  move(id: number, at: Point): void {
    const before = this.pointers.get(id);
    if (!before) {
      this.viewer.point(this.onMap(at));
      return;
    }
    if (this.begin && Math.hypot(at.x - this.begin.x, at.y - this.begin.y) > CLICK_PX) this.isClick = false;
    const all = [...this.pointers.values()] as [Point, Point];
    this.pointers.set(id, at);
    if (this.pointers.size === 2) this.pinch(all);
    else if (this.holdsDivider) this.viewer.see({divider: clamp(at.x / this.viewer.canvas.value.width, 0, 1)});
    else this.drag(before, at);
  }

  up(id: number, at: Point): void {
    this.pointers.delete(id);
    if (!this.isClick || this.viewer.tool.value !== 'move') return;
    this.viewer.hold(this.viewer.sight.value.pixel ? null : this.onMap(at));
  }

  cancel(id: number): void {
    this.pointers.delete(id);
  }

  wheel(at: Point, lines: number): void {
    this.viewer.move((view, canvas) => zoomed(view, 2 ** (-lines / 200), at, canvas));
  }

  private isOnDivider(at: Point): boolean {
    const {divider} = this.viewer.sight.value;
    const isDivided = divider !== null && (this.viewer.scene.value?.sides.length ?? 0) > 1;
    return isDivided && Math.abs(at.x - divider * this.viewer.canvas.value.width) < DIVIDER_PX;
  }

  private drag(before: Point, at: Point): void {
    if (!this.begin) return;
    switch (this.viewer.tool.value) {
      case 'move':
        if (!this.isClick) this.viewer.move((view) => panned(view, {x: at.x - before.x, y: at.y - before.y}));
        break;
      case 'light':
        this.shine(at);
        break;
      default:
        measure(this.viewer, this.onMap(this.begin), this.onMap(at));
    }
  }

  private pinch(before: [Point, Point]): void {
    const now = [...this.pointers.values()] as [Point, Point];
    this.viewer.move((view, canvas) => pinched(view, before, now, canvas));
  }

  private shine(at: Point): void {
    this.viewer.shine(lightAt(onDisc(at, this.viewer.canvas.value)));
  }

  private onMap(at: Point): Point {
    const view = this.viewer.view.value;
    return view ? toMap(at, view, this.viewer.canvas.value) : {x: -1, y: -1};
  }
}
