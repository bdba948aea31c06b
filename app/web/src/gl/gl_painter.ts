// SPDX-License-Identifier: Apache-2.0
// Paints scenes on a canvas by WebGL, from raw tiles that it asks the daemon for.
import {ApiError, fetched} from '../api/client';
import {tileBytes} from './formats';
import {Painter} from './painter';
import {type Scene, type Sheet, type Side, addressOf, addressesOf, drawnOf, overviewsOf, sheetsOf} from './scene';
import {type Draw, type LayerName, Surface, type TileTexture} from './surface';
import {TileStore} from './tile_store';
import {type Tile, boxOnCanvas, levelFor, repeats, tileBox, tileSize} from './tiles';
import type {Size} from './view';

export class GlPainter extends Painter {
  protected readonly store: TileStore<TileTexture>;
  /** How the bytes of tiles on their way are to be read. */
  private readonly kinds = new Map<string, {sheet: Sheet; tile: Tile}>();
  /** By texture, what is drawn on it. */
  private readonly drawn = new Map<string, string>();

  static on(canvas: HTMLCanvasElement, changed: () => void): GlPainter | null {
    const surface = Surface.on(canvas);
    return surface && new GlPainter(surface, changed);
  }

  private constructor(
    private readonly surface: Surface,
    changed: () => void,
  ) {
    super();
    this.store = new TileStore<TileTexture>(
      {
        load: (address, signal) => this.load(address, signal),
        bytes: (tile) => tile.bytes,
        free: (tile) => surface.free(tile),
      },
      changed,
    );
  }

  want(scene: Scene, canvas: Size): void {
    const sheets = scene.sides.flatMap((side) => sheetsOf(side, scene.bits.names));
    this.kinds.clear();
    for (const sheet of sheets) {
      const tiles = drawnOf(sheet.pyramid, scene, canvas, () => true);
      for (const tile of [...overviewsOf(sheet.pyramid), ...tiles]) this.kinds.set(addressOf(sheet, tile), {sheet, tile});
    }
    this.store.want(addressesOf(sheets, scene, canvas));
  }

  paint(scene: Scene, canvas: Size): void {
    const sheets = scene.sides.map((side) => sheetsOf(side, scene.bits.names));
    if (this.surface.resize(canvas)) this.drawn.clear();
    scene.sides.forEach((side, index) => {
      this.drawValues(index, sheets[index] ?? [], scene, canvas);
      if (side.bits.length) this.drawFlags(index, sheets[index] ?? [], scene, canvas);
      this.shade(index, side, scene, canvas);
    });
  }

  private async load(address: string, signal: AbortSignal): Promise<TileTexture> {
    const wanted = this.kinds.get(address);
    if (!wanted) throw new Error(`${address} is not wanted`);
    const {sheet, tile} = wanted;
    const bytes = await (await fetched(address, signal)).arrayBuffer();
    const size = tileSize(sheet.pyramid, tile);
    if (bytes.byteLength !== tileBytes(sheet.kind, size)) {
      throw new ApiError('A tile has not the size that it should have.', address, 'The maps changed, or the daemon is of another version.', 'Reload the page.', 0);
    }
    return this.surface.upload(sheet.kind, size, bytes);
  }

  private drawValues(side: number, sheets: readonly Sheet[], scene: Scene, canvas: Size): void {
    for (const sheet of sheets.filter(({kind}) => kind !== 'flags')) {
      const draws = this.drawsOf(sheet, scene, canvas);
      this.unlessDrawn(side, sheet.target, draws.name, () => this.surface.draw(side, sheet.target, draws.list));
    }
  }

  private drawFlags(side: number, sheets: readonly Sheet[], scene: Scene, canvas: Size): void {
    for (const target of ['flags_low', 'flags_high'] as const) {
      const channels = [0, 1, 2, 3].map((channel) => {
        const sheet = sheets.find((each) => each.target === target && each.channel === channel);
        return sheet ? this.drawsOf(sheet, scene, canvas) : {name: '', list: []};
      });
      const name = channels.map((each) => each.name).join('; ');
      this.unlessDrawn(side, target, name, () => this.surface.drawShares(side, target, channels.map(({list}) => list)));
    }
  }

  /** A light that moves finds its layers as they were. */
  private unlessDrawn(side: number, target: LayerName, content: string, draw: () => void): void {
    const texture = `${side} ${target}`;
    if (this.drawn.get(texture) === content) return;
    draw();
    this.drawn.set(texture, content);
  }

  private drawsOf(sheet: Sheet, scene: Scene, canvas: Size): {name: string; list: Draw[]} {
    const {pyramid} = sheet;
    const is_near = scene.view.zoom >= 1 && levelFor(pyramid, scene.view.zoom) === 0;
    const tiles = drawnOf(pyramid, scene, canvas, (tile) => this.store.get(addressOf(sheet, tile)) !== undefined);
    const list: Draw[] = [];
    const names: string[] = [`${scene.view.x} ${scene.view.y} ${scene.view.zoom} ${scene.repeat}`];
    for (const tile of tiles) {
      const texture = this.store.get(addressOf(sheet, tile));
      if (!texture) continue;
      names.push(addressOf(sheet, tile));
      for (const offset of repeats(pyramid, scene.repeat)) {
        list.push({
          tile: texture,
          to: boxOnCanvas(tileBox(pyramid, tile), offset, scene.view, canvas),
          within: boxOnCanvas({x: 0, y: 0, ...pyramid.size}, offset, scene.view, canvas),
          is_near: is_near && tile.level === 0,
        });
      }
    }
    return {name: names.join(' '), list};
  }

  private shade(index: number, side: Side, scene: Scene, canvas: Size): void {
    const {look} = scene;
    const at = scene.sides.length > 1 ? Math.round(scene.divider * canvas.width) : canvas.width;
    this.surface.shade(index, {
      mode: side.mode,
      has_flags: side.bits.length > 0,
      light: look.light,
      gain: side.gain * 2 ** look.exposure,
      range: look.range,
      bit_colours: [...scene.bits.colours],
      from_x: index === 0 ? 0 : at,
      to_x: index === 0 ? at : canvas.width,
      step: scene.is_moving ? 2 : 1,
    });
  }
}
