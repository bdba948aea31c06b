// SPDX-License-Identifier: Apache-2.0
// Tiles as WebGL takes them.
import type {TileKind} from './formats';
import type {Size} from './view';

const uploads = (gl: WebGL2RenderingContext): Record<TileKind, [GLenum, GLenum, GLenum]> => ({
  normal: [gl.RGB10_A2, gl.RGBA, gl.UNSIGNED_INT_2_10_10_10_REV],
  color: [gl.RGB16F, gl.RGB, gl.HALF_FLOAT],
  scalar: [gl.R16F, gl.RED, gl.HALF_FLOAT],
  flags: [gl.R8, gl.RED, gl.UNSIGNED_BYTE],
});

function valuesOf(kind: TileKind, bytes: ArrayBuffer): ArrayBufferView {
  if (kind === 'normal') return new Uint32Array(bytes);
  if (kind === 'flags') return new Uint8Array(bytes);
  return new Uint16Array(bytes);
}

/** 1023 texel steps are 1 to WebGL, 511 to either side of 511 to the daemon. */
export const NORMAL_SCALE = [1023 / 511, -1] as const;

/** The texture that is bound gets the texels of a tile. */
export function fillTexture(gl: WebGL2RenderingContext, kind: TileKind, size: Size, bytes: ArrayBuffer): void {
  const [internal, format, type] = uploads(gl)[kind];
  gl.texImage2D(gl.TEXTURE_2D, 0, internal, size.width, size.height, 0, format, type, valuesOf(kind, bytes));
}

/** A new texture, bound. */
export function sampledTexture(gl: WebGL2RenderingContext, filter: GLenum, wrap: GLenum): WebGLTexture {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrap);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrap);
  return texture;
}
