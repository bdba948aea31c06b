// SPDX-License-Identifier: Apache-2.0
// Paints scenes where the browser has no WebGL 2: the daemon shades the tiles, a 2D canvas shows them.
import {fetched} from '../api/client';
import {Painter} from './painter';
import {type Scene, type SceneLook, type Sheet, type Side, type TileForm, addressOf, addressesOf, drawnOf} from './scene';
import {TileStore} from './tile_store';
import {type Tile, boxOnCanvas, repeats, tileBox} from './tiles';
import {type Size, clamp} from './view';

/** Decimals that tell lights and exposures apart; more would only ask for more tiles. */
function rounded(value: number): string {
  return String(Number(value.toFixed(2)));
}

/** The pictures of a side, as the daemon is asked for them. */
export function pictureOf(side: Side, look: SceneLook): {sheet: Sheet; form: TileForm} {
  const sheet = (layer: string, words: Record<string, string>): Sheet => ({
    maps: side.maps,
    pyramid: side.pyramid,
    layer,
    query: `?${new URLSearchParams(words).toString()}`,
    kind: 'color',
    target: 'color',
    channel: 0,
  });
  const exposure = rounded(look.exposure);
  const [least, most] = look.range;
  switch (side.mode) {
    case 'color':
      return {sheet: sheet(side.layer, {exposure}), form: 'jpg'};
    case 'relit':
      return {sheet: sheet('relit', {exposure, light: look.light.map(rounded).join(',')}), form: 'jpg'};
    case 'normal':
      return {sheet: sheet(side.layer, {}), form: 'png'};
    case 'scalar': {
      const other: Record<string, string> = side.other === null ? {} : {with: side.other};
      return {sheet: sheet(side.layer, {least: String(least), most: String(most), ...other}), form: 'png'};
    }
    case 'flags':
      return {sheet: sheet('status', side.bits[0] === undefined ? {} : {bit: side.bits[0]}), form: 'png'};
  }
}

/** A picture of the daemon knows its size by itself, so that only its bytes as texels are counted. */
const BYTES_PER_PIXEL = 4;

export class PlainPainter extends Painter {
  protected readonly store: TileStore<ImageBitmap>;

  constructor(
    private readonly context: CanvasRenderingContext2D,
    changed: () => void,
  ) {
    super();
    this.store = new TileStore<ImageBitmap>(
      {
        load: async (address, signal) => createImageBitmap(await (await fetched(address, signal)).blob()),
        bytes: (tile) => tile.width * tile.height * BYTES_PER_PIXEL,
        free: (tile) => tile.close(),
      },
      changed,
    );
  }

  want(scene: Scene, canvas: Size): void {
    const pictures = scene.sides.map((side) => pictureOf(side, scene.look));
    this.store.want(pictures.flatMap(({sheet, form}) => addressesOf([sheet], scene, canvas, form)));
  }

  paint(scene: Scene, canvas: Size): void {
    const pictures = scene.sides.map((side) => pictureOf(side, scene.look));
    const element = this.context.canvas;
    if (element.width !== canvas.width || element.height !== canvas.height) {
      element.width = canvas.width;
      element.height = canvas.height;
    }
    this.context.fillStyle = '#050505';
    this.context.fillRect(0, 0, canvas.width, canvas.height);
    const at = pictures.length > 1 ? Math.round(scene.divider * canvas.width) : canvas.width;
    pictures.forEach(({sheet, form}, index) => {
      const from = index === 0 ? 0 : at;
      this.within(from, index === 0 ? at : canvas.width, canvas, () => this.draw(sheet, form, scene, canvas));
    });
  }

  private within(from: number, to: number, canvas: Size, draw: () => void): void {
    this.context.save();
    this.context.beginPath();
    this.context.rect(from, 0, to - from, canvas.height);
    this.context.clip();
    draw();
    this.context.restore();
  }

  private draw(sheet: Sheet, form: TileForm, scene: Scene, canvas: Size): void {
    this.context.imageSmoothingEnabled = scene.view.zoom < 1;
    const tileAt = (tile: Tile) => this.store.get(addressOf(sheet, tile, form));
    for (const tile of drawnOf(sheet.pyramid, scene, canvas, (each) => tileAt(each) !== undefined)) {
      const picture = tileAt(tile);
      if (!picture) continue;
      for (const offset of repeats(sheet.pyramid, scene.repeat)) {
        const to = boxOnCanvas(tileBox(sheet.pyramid, tile), offset, scene.view, canvas);
        this.context.drawImage(picture, to.x, to.y, clamp(to.width, 1, Infinity), clamp(to.height, 1, Infinity));
      }
    }
  }
}
