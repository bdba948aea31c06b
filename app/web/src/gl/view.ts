// SPDX-License-Identifier: Apache-2.0
// Where a map lies on a canvas. A pixel of the map is a square of side 1, the first one from (0, 0) to (1, 1).

export interface Size {
  width: number;
  height: number;
}

export interface Point {
  x: number;
  y: number;
}

export interface Box extends Point, Size {}

/** What of a map is seen: its point in the middle of the canvas, and pixels of the canvas a pixel of the map. */
export interface View extends Point {
  zoom: number;
}

export const MOST_ZOOM = 32;

/** The pixel of the canvas where the map begins: whole, so that from 1:1 on no pixel is seen blurred. */
export function originOf(view: View, canvas: Size): Point {
  return {x: Math.round(canvas.width / 2 - view.x * view.zoom), y: Math.round(canvas.height / 2 - view.y * view.zoom)};
}

export function toCanvas(point: Point, view: View, canvas: Size): Point {
  const origin = originOf(view, canvas);
  return {x: origin.x + point.x * view.zoom, y: origin.y + point.y * view.zoom};
}

export function toMap(point: Point, view: View, canvas: Size): Point {
  const origin = originOf(view, canvas);
  return {x: (point.x - origin.x) / view.zoom, y: (point.y - origin.y) / view.zoom};
}

/** The whole map, as large as the canvas lets it be. */
export function fitted(map: Size, canvas: Size): View {
  const zoom = Math.min(canvas.width / map.width, canvas.height / map.height);
  return {x: map.width / 2, y: map.height / 2, zoom: Math.min(Math.max(zoom, 1e-6), MOST_ZOOM)};
}

export function panned(view: View, by: Point): View {
  return {...view, x: view.x - by.x / view.zoom, y: view.y - by.y / view.zoom};
}

/** Nearer by a factor, with the point of the map that lies under `at` of the canvas held there. */
export function zoomed(view: View, factor: number, at: Point, canvas: Size): View {
  const zoom = view.zoom * factor;
  const held = toMap(at, view, canvas);
  return {x: held.x - (at.x - canvas.width / 2) / zoom, y: held.y - (at.y - canvas.height / 2) / zoom, zoom};
}

/** The next power of two, nearer or farther: 1:1 and 2:1 are met exactly. */
export function nextZoom(zoom: number, direction: 1 | -1): number {
  const power = Math.log2(zoom);
  const next = direction > 0 ? Math.floor(power + 1e-6) + 1 : Math.ceil(power - 1e-6) - 1;
  return 2 ** next;
}

/** A view that neither loses the map nor goes where nothing more is to be seen. */
export function held(view: View, map: Size, canvas: Size): View {
  const least = Math.min(fitted(map, canvas).zoom / 4, 1);
  return {
    x: clamp(view.x, 0, map.width),
    y: clamp(view.y, 0, map.height),
    zoom: clamp(view.zoom, least, MOST_ZOOM),
  };
}

export function clamp(value: number, least: number, most: number): number {
  return Math.min(Math.max(value, least), most);
}
