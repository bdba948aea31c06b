// SPDX-License-Identifier: Apache-2.0
// A direction to the light as a place on a disc: its middle is straight above, its edge is nearly level.
import type {Vector} from '../../gl/scene';
import {type Point, clamp} from '../../gl/view';

/** Lower than this, a light shows little but the sides of yarns. */
export const LOWEST_DEG = 5;

/** The direction for a place on the disc of radius 1; y goes down, as on a screen. */
export function lightAt(place: Point): Vector {
  const radius = Math.hypot(place.x, place.y);
  const most = Math.cos((LOWEST_DEG * Math.PI) / 180);
  const shrink = radius > most ? most / radius : 1;
  const x = place.x * shrink;
  const y = -place.y * shrink;
  return [x, y, Math.sqrt(1 - x * x - y * y)];
}

export function placeOf(light: Vector): Point {
  return {x: light[0], y: -light[1]};
}

export function heightDeg(light: Vector): number {
  return (Math.asin(clamp(light[2], -1, 1)) * 180) / Math.PI;
}

/** Degrees from the right, against the clock: 90 is the upper edge. */
export function azimuthDeg(light: Vector): number {
  const degrees = (Math.atan2(light[1], light[0]) * 180) / Math.PI;
  return Math.round(degrees < 0 ? degrees + 360 : degrees) % 360;
}

const sides = ['the right', 'the upper right', 'the top', 'the upper left', 'the left', 'the lower left', 'the bottom', 'the lower right'];

/** "from the upper left, 45 degrees high" */
export function lightInWords(light: Vector): string {
  const height = Math.round(heightDeg(light));
  if (height >= 88) return 'from straight above';
  const side = sides[Math.round(azimuthDeg(light) / 45) % 8] ?? '';
  return `from ${side}, ${height} degrees high`;
}

/** A light that a key moves by some degrees of the disc. */
export function nudged(light: Vector, by: Point): Vector {
  const place = placeOf(light);
  return lightAt({x: place.x + by.x, y: place.y + by.y});
}

export function isSame(a: Vector, b: Vector): boolean {
  return a.every((value, i) => Math.abs(value - (b[i] ?? 0)) < 1e-3);
}
