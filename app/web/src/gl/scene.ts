// SPDX-License-Identifier: Apache-2.0
// What is to be seen, and which tiles of which layers it takes.
import type {TileKind} from './formats';
import type {Rgb} from './heat';
import type {Mode} from './shaders';
import type {LayerName} from './surface';
import {type Pyramid, type Repeat, type Tile, levelFor, repeats, tilesInView} from './tiles';
import type {Point, Size, View} from './view';

export type Vector = [number, number, number];

/** The maps of one folder, shown in one way. */
export interface Side {
  /** The address of the maps: /api/v1/sessions/NAME/solves/ID, or /maps/ID */
  maps: string;
  pyramid: Pyramid;
  mode: Mode;
  /** What is seen: 'sigma', 'difference', 'bent_normal'. */
  layer: string;
  /** The solve that a difference is taken to, as SESSION/SOLVE; null: it is none. */
  other: string | null;
  /** What colours are multiplied by before the exposure: not 1 where the albedo has no absolute scale. */
  gain: number;
  /** Names of the status bits that are shown of these maps. */
  bits: readonly string[];
}

export interface SceneLook {
  /** To the light, unit, rig frame: x right, y up, z to the camera. */
  light: Vector;
  exposure: number;
  range: [number, number];
}

/** The bits of status in the daemon's order, each with its colour. */
export interface Bits {
  names: readonly string[];
  colours: readonly Rgb[];
}

export interface Scene {
  view: View;
  bits: Bits;
  /** One, or two with the second one right of the divider. */
  sides: readonly Side[];
  /** Share of the canvas's width. */
  divider: number;
  look: SceneLook;
  repeat: Repeat;
  /** A hand moves the light: half the resolution will do. */
  is_moving: boolean;
}

/** A layer of a side as tiles: where they come from and where they are drawn. */
export interface Sheet {
  maps: string;
  pyramid: Pyramid;
  layer: string;
  query: string;
  kind: TileKind;
  target: LayerName;
  /** Which of the target's four channels has these flags. */
  channel: number;
}

function sheetOf(side: Side, layer: string, kind: TileKind, target: LayerName): Sheet {
  return {maps: side.maps, pyramid: side.pyramid, layer, query: '', kind, target, channel: 0};
}

/** The layers that a side reads. `all_bits` tells a bit its place. */
export function sheetsOf(side: Side, all_bits: readonly string[]): Sheet[] {
  const sheets: Sheet[] = [];
  const isLit = side.mode === 'relit' || side.mode === 'flags';
  if (side.mode === 'normal' || isLit) sheets.push(sheetOf(side, isLit ? 'normal' : side.layer, 'normal', 'normal'));
  if (side.mode === 'color' || isLit) sheets.push(sheetOf(side, isLit ? 'albedo' : side.layer, 'color', 'color'));
  if (side.mode === 'scalar') {
    const query = side.other === null ? '' : `?with=${encodeURIComponent(side.other)}`;
    sheets.push({...sheetOf(side, side.layer, 'scalar', 'scalar'), query});
  }
  for (const bit of side.bits) {
    const place = all_bits.indexOf(bit);
    if (place < 0) continue;
    const sheet = sheetOf(side, 'status', 'flags', place < 4 ? 'flags_low' : 'flags_high');
    sheets.push({...sheet, query: `?bit=${bit}`, channel: place % 4});
  }
  return sheets;
}

/** raw: for programs. png, jpg: for people. */
export type TileForm = 'raw' | 'png' | 'jpg';

export function addressOf(sheet: Sheet, tile: Tile, form: TileForm = 'raw'): string {
  return `${sheet.maps}/tiles/${sheet.layer}/${tile.level}/${tile.column}_${tile.row}.${form}${sheet.query}`;
}

/** The tiles of a sheet that a view wants: the whole map, by what any line brings at once and by one tile; then those of the right level. */
export interface Wanted {
  overviews: Tile[];
  tiles: Tile[];
}

export function overviewsOf({levels, size: {width, height}, side}: Pyramid): Tile[] {
  const top = Math.max(0, Math.ceil(Math.log2(Math.max(width, height) / side)));
  return [...new Set([levels - 1, top])].map((level) => ({level, column: 0, row: 0}));
}

export function wantedOf(pyramid: Pyramid, view: View, canvas: Size, offsets: Point[]): Wanted {
  const level = levelFor(pyramid, view.zoom);
  return {
    overviews: overviewsOf(pyramid),
    tiles: tilesInView(pyramid, level, view, canvas, offsets),
  };
}

/** The tile of the next level that has this one in it. */
function above({level, column, row}: Tile): Tile {
  return {level: level + 1, column: column >> 1, row: row >> 1};
}

/** What is drawn of a sheet: the wanted tiles that are there, and below each gap the finest coarser one. */
export function drawnOf(pyramid: Pyramid, scene: Scene, canvas: Size, is_there: (tile: Tile) => boolean): Tile[] {
  const {view, repeat} = scene;
  const wanted = tilesInView(pyramid, levelFor(pyramid, view.zoom), view, canvas, repeats(pyramid, repeat));
  const below = new Map<string, Tile>();
  for (const gap of wanted.filter((tile) => !is_there(tile))) {
    let tile = above(gap);
    while (tile.level < pyramid.levels && !is_there(tile)) tile = above(tile);
    if (tile.level < pyramid.levels) below.set(`${tile.level}/${tile.column}_${tile.row}`, tile);
  }
  return [...[...below.values()].sort((a, b) => b.level - a.level), ...wanted.filter(is_there)];
}

/** Addresses of all that a scene needs, in the order in which they are wanted. */
export function addressesOf(sheets: readonly Sheet[], scene: Scene, canvas: Size, form: TileForm = 'raw'): string[] {
  const overviews: {address: string; turn: number}[] = [];
  const tiles: {address: string; turn: number}[] = [];
  for (const sheet of sheets) {
    const wanted = wantedOf(sheet.pyramid, scene.view, canvas, repeats(sheet.pyramid, scene.repeat));
    wanted.overviews.forEach((tile, turn) => overviews.push({address: addressOf(sheet, tile, form), turn}));
    wanted.tiles.forEach((tile, turn) => tiles.push({address: addressOf(sheet, tile, form), turn}));
  }
  const inTurn = (those: typeof tiles) => those.sort((a, b) => a.turn - b.turn).map(({address}) => address);
  return [...new Set([...inTurn(overviews), ...inTurn(tiles)])];
}
