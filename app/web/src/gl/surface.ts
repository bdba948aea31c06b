// SPDX-License-Identifier: Apache-2.0
// Tiles are drawn into textures of the canvas's size, one a layer; one pass over them makes the picture. So a light
// that moves costs that pass alone and touches no tile.
import type {TileKind} from './formats';
import {HEAT_STEPS, type Rgb, heatTexels} from './heat';
import {Program} from './program';
import {COPY, COPY_SHARE, type Mode, RECTANGLE, shading} from './shaders';
import {fillTexture, NORMAL_SCALE, sampledTexture} from './upload';
import type {Box, Size} from './view';

export interface TileTexture extends Size {
  texture: WebGLTexture;
  bytes: number;
}

/** A tile at its place on the canvas, within the box of its map. */
export interface Draw {
  tile: TileTexture;
  to: Box;
  within: Box;
  /** Seen pixel by pixel, without a mean of neighbours. */
  is_near: boolean;
}

/** Flags share textures, four a texture. */
export type LayerName = 'normal' | 'color' | 'scalar' | 'flags_low' | 'flags_high';

export interface Shading {
  mode: Mode;
  has_flags: boolean;
  light: [number, number, number];
  gain: number;
  range: [number, number];
  bit_colours: Rgb[];
  /** What is shaded, in pixels of the canvas: the other side of a divider is not. */
  from_x: number;
  to_x: number;
  /** 2: at half the resolution, while a hand moves the light. */
  step: 1 | 2;
}

interface Target {
  texture: WebGLTexture;
  frame: WebGLFramebuffer;
}

/** The one canvas of a viewer. Made anew after its context was lost. */
export class Surface {
  private readonly gl: WebGL2RenderingContext;
  private readonly copy: Program;
  private readonly copyShare: Program;
  private readonly heat: WebGLTexture;
  private readonly shadings = new Map<string, Program>();
  private readonly targets = new Map<string, Target>();
  private size: Size = {width: 0, height: 0};

  /** Null where the browser has no WebGL 2 that can draw to half floats. */
  static on(canvas: HTMLCanvasElement): Surface | null {
    const gl = canvas.getContext('webgl2', {alpha: false, antialias: false, depth: false, powerPreference: 'high-performance'});
    if (!gl?.getExtension('EXT_color_buffer_float')) return null;
    return new Surface(gl);
  }

  private constructor(gl: WebGL2RenderingContext) {
    this.gl = gl;
    this.copy = new Program(gl, RECTANGLE, COPY);
    this.copyShare = new Program(gl, RECTANGLE, COPY_SHARE);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.bindVertexArray(gl.createVertexArray());
    this.heat = this.sampled(gl.LINEAR);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, HEAT_STEPS, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, heatTexels());
  }

  upload(kind: TileKind, size: Size, bytes: ArrayBuffer): TileTexture {
    const texture = this.sampled(this.gl.LINEAR);
    fillTexture(this.gl, kind, size, bytes);
    return {texture, ...size, bytes: bytes.byteLength};
  }

  free(tile: TileTexture): void {
    this.gl.deleteTexture(tile.texture);
  }

  /** Whether that was another size: then all layers are to be drawn again. */
  resize(size: Size): boolean {
    if (size.width === this.size.width && size.height === this.size.height) return false;
    this.size = size;
    for (const target of this.targets.values()) {
      this.gl.deleteTexture(target.texture);
      this.gl.deleteFramebuffer(target.frame);
    }
    this.targets.clear();
    return true;
  }

  /** Draws tiles into the texture of a side's layer, later ones over earlier ones. */
  draw(side: number, layer: LayerName, draws: Draw[]): void {
    const {gl} = this;
    this.begin(this.target(`${side} ${layer}`));
    this.copy.use();
    const [factor, offset] = layer === 'normal' ? NORMAL_SCALE : [1, 0];
    gl.uniform2f(this.copy.at('scale'), factor, offset);
    this.drawTiles(this.copy, draws);
  }

  /** Draws the tiles of flags, one list a channel, into the texture of a side's layer. */
  drawShares(side: number, layer: LayerName, channels: Draw[][]): void {
    const {gl} = this;
    this.begin(this.target(`${side} ${layer}`));
    this.copyShare.use();
    channels.forEach((draws, channel) => {
      gl.colorMask(channel === 0, channel === 1, channel === 2, channel === 3);
      this.drawTiles(this.copyShare, draws);
    });
    gl.colorMask(true, true, true, true);
  }

  /** Makes the picture of a side from its layers, within a part of the canvas. */
  shade(side: number, look: Shading): void {
    const {gl} = this;
    const program = this.shading(look);
    this.show(look.step);
    program.use();
    const layers: (LayerName | 'heat')[] = ['normal', 'color', 'scalar', 'flags_low', 'flags_high', 'heat'];
    layers.forEach((layer, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, layer === 'heat' ? this.heat : (this.targets.get(`${side} ${layer}`)?.texture ?? null));
      gl.uniform1i(program.at(layer), unit);
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform3f(program.at('light'), ...look.light);
    gl.uniform3fv(program.at('bit_colours'), look.bit_colours.flat());
    gl.uniform1f(program.at('gain'), look.gain);
    gl.uniform2f(program.at('range'), ...look.range);
    gl.uniform1i(program.at('step'), look.step);
    const from = Math.floor(look.from_x / look.step);
    const to = Math.ceil(look.to_x / look.step);
    this.within({x: from, y: 0, width: to - from, height: gl.canvas.height});
    gl.uniform4f(program.at('rect'), -1, -1, 2, 2);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.disable(gl.SCISSOR_TEST);
  }

  /** Draws to the canvas itself from here on. With fewer pixels the page stretches it, which costs the least. */
  private show(step: number): void {
    const {gl} = this;
    const width = Math.ceil(this.size.width / step);
    const height = Math.ceil(this.size.height / step);
    if (gl.canvas.width !== width || gl.canvas.height !== height) {
      gl.canvas.width = width;
      gl.canvas.height = height;
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
  }

  private begin(target: Target): void {
    const {gl} = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    gl.viewport(0, 0, this.size.width, this.size.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  private drawTiles(program: Program, draws: Draw[]): void {
    const {gl} = this;
    gl.uniform1i(program.at('tile'), 0);
    for (const {tile, to, within, is_near} of draws) {
      this.within({...within, y: this.size.height - within.y - within.height});
      gl.bindTexture(gl.TEXTURE_2D, tile.texture);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, is_near ? gl.NEAREST : gl.LINEAR);
      const across = 2 / this.size.width;
      const down = -2 / this.size.height;
      gl.uniform4f(program.at('rect'), to.x * across - 1, 1 + to.y * down, to.width * across, to.height * down);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
    gl.disable(gl.SCISSOR_TEST);
  }

  /** Nothing is drawn outside, until the test is disabled. */
  private within(box: Box): void {
    const {gl} = this;
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(box.x, box.y, Math.max(box.width, 0), Math.max(box.height, 0));
  }

  private shading({mode, has_flags}: Shading): Program {
    const name = `${mode} ${has_flags}`;
    const known = this.shadings.get(name);
    if (known) return known;
    const program = new Program(this.gl, RECTANGLE, shading(mode, has_flags));
    this.shadings.set(name, program);
    return program;
  }

  private target(name: string): Target {
    const known = this.targets.get(name);
    if (known) return known;
    const {gl} = this;
    const texture = this.sampled(gl.NEAREST);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA16F, Math.max(1, this.size.width), Math.max(1, this.size.height));
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    const target = {texture, frame};
    this.targets.set(name, target);
    return target;
  }

  private sampled(filter: GLenum): WebGLTexture {
    return sampledTexture(this.gl, filter, this.gl.CLAMP_TO_EDGE);
  }
}
