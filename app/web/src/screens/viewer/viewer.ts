// SPDX-License-Identifier: Apache-2.0
// The state of a viewer: what is looked at, what is known of it, and the scene that follows.
import {batch, computed, effect, signal, type Signal} from '@preact/signals';
import {answer, api, type ApiError, asApiError, type Schemas} from '../../api/client';
import type {Scene, Side, Vector} from '../../gl/scene';
import {fieldsOf, listIn, textIn} from '../../ui/fields';
import {type Box, type Point, type Size, type View, clamp, fitted, held} from '../../gl/view';
import {amend, place} from '../../state/address';
import {beginsAtZero, bitColour, bitsOf, fullScale, hasScale, isDifference, isThere} from './layers';
import {Latest} from './latest';
import {askOf, isSameSize, loadMaps, type Maps, sideOf} from './maps';
import {channelsOf, type PixelFacts, type RegionFacts, sharesOf} from './probe';
import {asWritten, queryOf, type Sight, sightOf, type SolveName} from './sight';

export type Tool = 'move' | 'light' | 'ruler' | 'region';

/** What keys draw with, in pixels of the map; null in a viewer: no key has led it yet. */
export interface Pencil {
  at: Point;
  /** Where what it draws begins; null: it draws nothing. */
  begin: Point | null;
}

function towards(x: number, y: number, z: number): Vector {
  const length = Math.hypot(x, y, z) || 1;
  return [x / length, y / length, z / length];
}

const WRITE_MS = 200;
const SETTLE_MS = 150;
const PROBE_MS = 60;
const AGAIN_MS = 300;

export class Viewer {
  readonly sight: Signal<Sight>;
  readonly maps = signal<Maps | null>(null);
  readonly other = signal<Maps | null>(null);
  readonly canvas = signal<Size>({width: 0, height: 0});
  readonly tool = signal<Tool>('move');
  readonly isLightMoving = signal(false);
  readonly pencil = signal<Pencil | null>(null);
  /** The daemon's figures of the whole map, once they were needed. */
  readonly whole = signal<RegionFacts | null>(null);
  readonly comparison = signal<Schemas['Comparison'] | null>(null);
  readonly pixel = signal<PixelFacts | null>(null);
  /** By LED, the direction to it from the middle of the table. */
  readonly leds = computed<readonly {led: number; light: Vector}[]>(() => {
    const solve = this.maps.value?.solve;
    return solve?.leds.map(({led, position_mm: [x = 0, y = 0, z = 0]}) => ({led, light: towards(x, y, z - solve.cloth_height_mm)})) ?? [];
  });
  readonly complaint = signal<ApiError | null>(null);
  readonly pixelComplaint = signal<ApiError | null>(null);

  private readonly ends: (() => void)[] = [];
  private readonly probe: Latest<Point, PixelFacts>;
  private writeTimer = 0;
  private settleTimer = 0;
  private againTimer = 0;
  private isClosed = false;

  /** Until the maps are there, or cannot be had. */
  private readonly loaded: Promise<void>;

  constructor(readonly name: SolveName) {
    this.sight = signal(sightOf(place.value.query));
    this.probe = new Latest(
      (at) => this.askPixel(at),
      (pixel, at) => this.takePixel(pixel, at),
      (error) => (this.pixelComplaint.value = asApiError(error)),
      PROBE_MS,
    );
    this.loaded = this.load(name, this.maps);
    this.ends.push(
      effect(() => this.followPlace(place.value.query)),
      effect(() => this.followOther(this.beside.value)),
      effect(() => this.followPixel(this.sight.value.pixel)),
      effect(() => {
        if (this.needsWhole.value) void this.askWhole();
      }),
    );
  }

  close(): void {
    this.isClosed = true;
    this.ends.forEach((end) => end());
    this.probe.forget();
    clearTimeout(this.writeTimer);
    clearTimeout(this.settleTimer);
    clearTimeout(this.againTimer);
  }

  /** Where the map lies on the canvas; null until both are known. */
  readonly view = computed<View | null>(() => {
    const maps = this.maps.value;
    const canvas = this.canvas.value;
    if (!maps || canvas.width === 0) return null;
    return this.sight.value.view ?? fitted(maps.solve, canvas);
  });

  /** Where the cloth before its finish lies on the maps of a set, and on that cloth the corners of the maps; null: nobody knows. */
  readonly before = computed<(Point & {corners: unknown[]}) | null>(() => {
    const solve = this.maps.value?.solve;
    const place = fieldsOf(solve?.set)['place'];
    const [x, y] = listIn(place, 'centre_px') as number[];
    return solve && x !== undefined && y !== undefined ? {x: solve.width / 2 - x, y: solve.height / 2 - y, corners: listIn(place, 'corners_px')} : null;
  });

  /** What may be seen beside the maps: another solve, and of a set, which lies on a grid of its own, what it was made of. */
  private readonly beside = computed<SolveName | null>(() => {
    const {divider, other} = this.sight.value;
    if (!this.name.isSet) return other;
    return divider === null || !this.before.value ? null : {...this.name, solve: textIn(this.maps.value?.solve.set, 'rectified')};
  });

  readonly panel = computed(() => this.sight.value.panel);

  readonly range = computed<[number, number]>(() => this.sight.value.range ?? this.ownRange());

  /** The bits over the picture; of the layer of status those that occur but those of lobes, which are no faults, unless others are chosen. */
  readonly bits = computed<readonly string[]>(() => {
    const {bits, layer} = this.sight.value;
    const maps = this.maps.value;
    if (bits || layer !== 'status' || !maps) return bits ?? [];
    const shares = this.whole.value && sharesOf(this.whole.value);
    return shares ? bitsOf(maps.solve).filter((bit) => !/GLOSSY|YARN|LOBE/.test(bit) && (shares[bit] ?? 0) > 0) : [];
  });

  readonly scene = computed<Scene | null>(() => {
    const view = this.view.value;
    const maps = this.maps.value;
    const sides = this.sides();
    if (!view || !maps || sides.length === 0) return null;
    const names = bitsOf(maps.solve);
    const bits = {names, colours: names.map(bitColour)};
    const {light, exposure, divider, repeat} = this.sight.value;
    const look = {light, exposure, range: this.range.value};
    return {view, bits, sides, divider: divider ?? 1, look, repeat, is_moving: this.isLightMoving.value};
  });

  /** Changes what is looked at. A step is something that Back undoes, a slide is not. */
  see(changes: Partial<Sight>, how: 'step' | 'slide' = 'slide'): void {
    this.sight.value = {...this.sight.value, ...changes};
    clearTimeout(this.writeTimer);
    if (how === 'step') this.write(false);
    else this.writeTimer = window.setTimeout(() => this.write(true), WRITE_MS);
  }

  seeLayer(layer: string): void {
    const maps = this.maps.value;
    if (maps && isThere(maps.solve, layer)) this.see({layer, range: null, bits: null}, 'step');
  }

  /** Changes the place of the map by what it is now. */
  move(change: (view: View, canvas: Size) => View): void {
    const maps = this.maps.value;
    const view = this.view.value;
    if (!maps || !view) return;
    const canvas = this.canvas.value;
    this.see({view: held(change(view, canvas), maps.solve, canvas)});
  }

  /** Turns the light, roughly for as long as it moves. */
  shine(light: Vector): void {
    batch(() => {
      this.isLightMoving.value = true;
      this.see({light});
    });
    clearTimeout(this.settleTimer);
    this.settleTimer = window.setTimeout(() => (this.isLightMoving.value = false), SETTLE_MS);
  }

  /** Asks about the pixel under a point of the map; a pixel that is held stays. */
  point(at: Point): void {
    const size = this.maps.value?.solve;
    if (!size || this.sight.value.pixel) return;
    const x = Math.floor(at.x);
    const y = Math.floor(at.y);
    if (x >= 0 && y >= 0 && x < size.width && y < size.height) this.probe.want({x, y});
  }

  /** Holds the table of a pixel, or lets it go. */
  hold(at: Point | null): void {
    const size = this.maps.value?.solve;
    const inside = at && size && {x: clamp(Math.floor(at.x), 0, size.width - 1), y: clamp(Math.floor(at.y), 0, size.height - 1)};
    this.see(inside ? {pixel: inside, panel: 'pixel'} : {pixel: null});
  }

  askRegion(box: Box): Promise<RegionFacts> {
    const query = {x: box.x, y: box.y, w: box.width, h: box.height};
    return askOf(this.name, '/region', query);
  }

  askLine([from, to]: [Point, Point]): Promise<Schemas['LineFacts']> {
    const query = {x0: from.x, y0: from.y, x1: to.x, y1: to.y};
    return askOf(this.name, '/line', query);
  }

  private write(replace: boolean): void {
    this.sight.value = asWritten(this.sight.value);
    amend(queryOf(this.sight.value), replace);
  }

  /** Back, Forward and links change the sight; what was written from here says what is seen already. */
  private followPlace(query: URLSearchParams): void {
    const said = sightOf(query);
    if (JSON.stringify(said) === JSON.stringify(asWritten(this.sight.peek()))) return;
    clearTimeout(this.writeTimer);
    this.sight.value = said;
  }

  private followOther(name: SolveName | null): void {
    const known = this.other.peek()?.name;
    if (name?.session === known?.session && name?.solve === known?.solve) return;
    this.other.value = null;
    this.comparison.value = null;
    if (name) void this.load(name, this.other);
  }

  private followPixel(pixel: Point | null): void {
    const known = this.pixel.peek();
    if (pixel && (pixel.x !== known?.x || pixel.y !== known.y)) this.probe.want(pixel);
  }

  private async load(name: SolveName, into: Signal<Maps | null>): Promise<void> {
    try {
      const maps = await loadMaps(name);
      if (this.isClosed) return;
      into.value = maps;
      if (into === this.maps) return;
      await this.loaded;
      const first = this.maps.peek();
      if (first && !name.isSet && isSameSize(first, maps)) await this.compare(name);
    } catch (error) {
      this.complaint.value = asApiError(error);
    }
  }

  private async compare(other: SolveName): Promise<void> {
    const {session, solve} = this.name;
    const query = {a: `${session}/${solve}`, b: `${other.session}/${other.solve}`};
    const comparison = await answer(api.GET('/api/v1/compare', {params: {query}}));
    if (this.other.value?.name === other) this.comparison.value = comparison;
  }

  private sides(): Side[] {
    const maps = this.maps.value;
    if (!maps) return [];
    const {layer, divider} = this.sight.value;
    const other = this.other.value;
    if (isDifference(layer) && (!other || !isSameSize(maps, other))) return [];
    const first = sideOf(maps, layer, this.bits.value, this.sight.value.other);
    if (!first) return [];
    const at = this.before.value;
    const isDivided = divider !== null && !isDifference(layer) && other && (at || isSameSize(maps, other));
    const second = isDivided ? sideOf(other, layer, this.bits.value, null) : null;
    if (second && at) return [{...second, gain: first.gain, pyramid: {...second.pyramid, at}}, first];
    return second ? [first, second] : [first];
  }

  private readonly needsWhole = computed(() => {
    const {layer} = this.sight.value;
    const solve = this.maps.value?.solve;
    return solve !== undefined && (layer === 'status' || (hasScale(solve, layer) && !isDifference(layer)));
  });

  /** The picture will change once the daemon's figures are there. */
  readonly isComing = computed(() => {
    const {layer, range, bits} = this.sight.value;
    return this.needsWhole.value && this.whole.value === null && (layer === 'status' ? bits : range) === null;
  });

  private async askWhole(): Promise<void> {
    const size = this.maps.peek()?.solve;
    if (!size || this.whole.peek()) return;
    try {
      this.whole.value = await this.askRegion({x: 0, y: 0, width: size.width, height: size.height});
    } catch (error) {
      this.complaint.value = asApiError(error);
    }
  }

  private ownRange(): [number, number] {
    const {layer} = this.sight.value;
    const compared = this.comparison.value;
    if (layer === 'difference') return [0, fullScale(compared?.normal.p95_deg ?? 3)];
    if (layer === 'albedo_difference') return [0, fullScale(200 * (compared?.albedo.mean_rel ?? 0.01))];
    if (layer === 'condition') return [0, 8];
    const facts = this.whole.value && Object.values(channelsOf(this.whole.value, layer))[0];
    if (!facts) return [0, 1];
    return beginsAtZero(layer) ? [0, fullScale(facts.p95)] : [facts.p5, Math.max(facts.p95, facts.p5 + 1e-6)];
  }

  private askPixel(at: Point): Promise<PixelFacts> {
    return askOf(this.name, '/pixel', {...at});
  }

  private takePixel(pixel: PixelFacts, at: Point): void {
    if (this.isClosed) return;
    this.pixel.value = pixel;
    this.pixelComplaint.value = null;
    const hasReadings = !this.name.isSet && this.name.solve !== 'truth';
    clearTimeout(this.againTimer);
    if (pixel.readings === null && hasReadings) this.againTimer = window.setTimeout(() => this.probe.want(at), AGAIN_MS);
  }
}
