// SPDX-License-Identifier: Apache-2.0
// The maps of a cloth as whole textures with their means at every scale, and the pass that shades them.
import {fetched} from '../api/client';
import {CLOTH} from './cloth_shader';
import type {TileKind} from './formats';
import {shareTexels, TABLE_SIDE} from './lobes';
import {Program} from './program';
import type {Vector} from './scene';
import {COPY, COPY_SHARE, RECTANGLE} from './shaders';
import {levelSize, type Pyramid, type Tile, tileSize} from './tiles';
import {fillTexture, NORMAL_SCALE, sampledTexture} from './upload';
import type {Size} from './view';

const MOST_SIDE = 2048;
const AT_ONCE = 4;

const TARGETS = ['normal', 'color', 'scalars', 'sheens', 'tints'] as const;
type Target = (typeof TARGETS)[number];

/** A layer of the maps, and where in the textures it goes. */
export interface ClothLayer {
  layer: string;
  kind: TileKind;
  target: Target;
  /** Which of the target's channels has this scalar. */
  channel?: number;
}

export interface ClothMaps {
  /** Their address. */
  maps: string;
  pyramid: Pyramid;
  layers: readonly ClothLayer[];
  /** Whether its right border goes on at the left one. */
  repeats: boolean;
}

export type Four = [number, number, number, number];

export interface ClothLook {
  canvas: Size;
  /** Pixels of the canvas. */
  px_per_mm: number;
  cloth_mm: [number, number];
  /** How many pieces are shown a side; null: as many as there is room for. */
  cells: number | null;
  /** Radius of the ball; 0: flat. */
  radius_mm: number;
  slant_deg: number;
  light: Vector;
  gain: number;
  exposure: number;
  /** Radiance, the lamp's white cloth being 1. */
  surroundings: number;
  metallic: number;
  /** Albedo where it is the same everywhere; null: it is a map. */
  typed_color: Vector | null;
  /** Occlusion, roughness, opacity, f0 where they are numbers, and which of them are maps (1). */
  typed: Four;
  mapped: Four;
  /** f0 of each channel over f0 where it is the same everywhere; null: it is a map. */
  typed_tint: Vector | null;
  typed_sheen: Four;
  mapped_sheen: Four;
  step: 1 | 2;
}

/** The finest level whose sides a texture may have. */
export function levelOf(pyramid: Pyramid, most = MOST_SIDE): number {
  for (let level = 0; level < pyramid.levels - 1; ++level) {
    const {width, height} = levelSize(pyramid, level);
    if (Math.max(width, height) <= most) return level;
  }
  return pyramid.levels - 1;
}

/** The one canvas of a material. Made anew after its context was lost. */
export class ClothSurface {
  private readonly copy: Program;
  private readonly copyShare: Program;
  private readonly shade: Program;
  private readonly shares: WebGLTexture;
  private readonly textures = new Map<Target, WebGLTexture>();
  /** Where there is no map: a normal that faces the eye. */
  private readonly empty: WebGLTexture;

  /** Null where the browser has no WebGL 2 that can draw to half floats. */
  static on(canvas: HTMLCanvasElement): ClothSurface | null {
    const gl = canvas.getContext('webgl2', {alpha: false, antialias: false, depth: false, powerPreference: 'high-performance'});
    return gl?.getExtension('EXT_color_buffer_float') ? new ClothSurface(gl) : null;
  }

  private constructor(private readonly gl: WebGL2RenderingContext) {
    this.copy = new Program(gl, RECTANGLE, COPY);
    this.copyShare = new Program(gl, RECTANGLE, COPY_SHARE);
    this.shade = new Program(gl, RECTANGLE, CLOTH);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.bindVertexArray(gl.createVertexArray());
    this.shares = sampledTexture(gl, gl.LINEAR, gl.CLAMP_TO_EDGE);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, TABLE_SIDE, TABLE_SIDE, 0, gl.RGBA, gl.UNSIGNED_BYTE, shareTexels());
    this.empty = sampledTexture(gl, gl.NEAREST, gl.CLAMP_TO_EDGE);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 1, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array([0, 0, 255, 255]));
  }

  /** Fetches all layers and puts them in place of those before. Throws an ApiError; nothing where it is aborted. */
  async load(maps: ClothMaps, signal: AbortSignal): Promise<void> {
    const {gl} = this;
    for (const texture of this.textures.values()) gl.deleteTexture(texture);
    this.textures.clear();
    const level = levelOf(maps.pyramid, Math.min(MOST_SIDE, gl.getParameter(gl.MAX_TEXTURE_SIZE) as number));
    const size = levelSize(maps.pyramid, level);
    for (const {target} of maps.layers) {
      if (!this.textures.has(target)) this.textures.set(target, this.storage(size, maps.repeats));
    }
    const tiles: (() => Promise<void>)[] = [];
    for (const layer of maps.layers) {
      for (let row = 0; row * maps.pyramid.side < size.height; ++row) {
        for (let column = 0; column * maps.pyramid.side < size.width; ++column) {
          tiles.push(() => this.take(maps, layer, {level, column, row}, signal));
        }
      }
    }
    const work = async () => {
      for (let next = tiles.shift(); next; next = tiles.shift()) await next();
    };
    await Promise.all(Array.from({length: AT_ONCE}, work));
    if (signal.aborted) return;
    for (const texture of this.textures.values()) {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.generateMipmap(gl.TEXTURE_2D);
    }
  }

  draw(look: ClothLook): void {
    const {gl, shade} = this;
    const {width, height} = look.canvas;
    this.show(Math.ceil(width / look.step), Math.ceil(height / look.step));
    shade.use();
    const units: [string, WebGLTexture][] = TARGETS.map((name) => [name, this.textures.get(name) ?? this.empty]);
    [...units, ['shares', this.shares] as const].forEach(([name, texture], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(shade.at(name), unit);
    });
    gl.activeTexture(gl.TEXTURE0);
    const cells = look.cells ?? 1;
    gl.uniform2f(shade.at('canvas'), width, height);
    gl.uniform2f(shade.at('cloth_mm'), ...look.cloth_mm);
    gl.uniform2f(shade.at('cells'), cells, cells);
    gl.uniform1i(shade.at('is_endless'), look.cells === null ? 1 : 0);
    const numbers = {
      px_per_mm: look.px_per_mm, radius_mm: look.radius_mm, slant: (look.slant_deg * Math.PI) / 180, gain: look.gain,
      brightness: 2 ** look.exposure, surroundings: look.surroundings, metallic: look.metallic, step: look.step,
      mapped_color: look.typed_color ? 0 : 1, mapped_tint: look.typed_tint ? 0 : 1,
    };
    for (const [name, number] of Object.entries(numbers)) gl.uniform1f(shade.at(name), number);
    gl.uniform3f(shade.at('light'), ...look.light);
    gl.uniform3f(shade.at('typed_color'), ...(look.typed_color ?? look.light));
    gl.uniform3f(shade.at('typed_tint'), ...(look.typed_tint ?? look.light));
    for (const name of ['typed', 'mapped', 'typed_sheen', 'mapped_sheen'] as const) gl.uniform4f(shade.at(name), ...look[name]);
    gl.uniform4f(shade.at('rect'), -1, -1, 2, 2);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  close(): void {
    for (const texture of [...this.textures.values(), this.shares, this.empty]) this.gl.deleteTexture(texture);
    this.textures.clear();
  }

  /** Draws to the canvas itself from here on. With fewer pixels the page stretches it. */
  private show(width: number, height: number): void {
    const {gl} = this;
    if (gl.canvas.width !== width || gl.canvas.height !== height) {
      gl.canvas.width = width;
      gl.canvas.height = height;
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
  }

  /** A texture of all levels, empty. */
  private storage(size: Size, repeats: boolean): WebGLTexture {
    const {gl} = this;
    const texture = sampledTexture(gl, gl.LINEAR, repeats ? gl.REPEAT : gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texStorage2D(gl.TEXTURE_2D, 1 + Math.floor(Math.log2(Math.max(size.width, size.height))), gl.RGBA16F, size.width, size.height);
    return texture;
  }

  /** Fetches a tile and draws it into its place of the layer's texture. */
  private async take(maps: ClothMaps, layer: ClothLayer, tile: Tile, signal: AbortSignal): Promise<void> {
    if (signal.aborted) return;
    const address = `${maps.maps}/tiles/${layer.layer}/${tile.level}/${tile.column}_${tile.row}.raw`;
    const bytes = await (await fetched(address, signal)).arrayBuffer();
    const target = this.textures.get(layer.target);
    if (signal.aborted || !target) return;
    const {gl} = this;
    const size = tileSize(maps.pyramid, tile);
    const texels = sampledTexture(gl, gl.NEAREST, gl.CLAMP_TO_EDGE);
    fillTexture(gl, layer.kind, size, bytes);
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
    gl.viewport(tile.column * maps.pyramid.side, tile.row * maps.pyramid.side, size.width, size.height);
    this.fill(layer);
    gl.deleteFramebuffer(frame);
    gl.deleteTexture(texels);
  }

  /** The whole viewport gets the texture that is bound. */
  private fill({kind, channel}: ClothLayer): void {
    const {gl} = this;
    const program = kind === 'scalar' ? this.copyShare : this.copy;
    program.use();
    gl.uniform1i(program.at('tile'), 0);
    gl.uniform4f(program.at('rect'), -1, -1, 2, 2);
    if (kind === 'scalar') {
      gl.colorMask(channel === 0, channel === 1, channel === 2, channel === 3);
    } else {
      const [factor, offset] = kind === 'normal' ? NORMAL_SCALE : [1, 0];
      gl.uniform2f(program.at('scale'), factor, offset);
      gl.colorMask(true, true, true, false);
    }
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.colorMask(true, true, true, true);
  }
}
