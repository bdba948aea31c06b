// SPDX-License-Identifier: Apache-2.0
// The programs of the surface. What a mode does not show, its variant does not read.

export type Mode = 'color' | 'normal' | 'relit' | 'scalar' | 'flags';

/** A rectangle, `rect` being its x, y, width and height in clip space. */
export const RECTANGLE = `#version 300 es
uniform vec4 rect;
out vec2 uv;
void main() {
  uv = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(rect.xy + uv * rect.zw, 0.0, 1.0);
}`;

/** A tile into the texture of its layer: values as they are, alpha 1 where there are any. */
export const COPY = `#version 300 es
precision highp float;
uniform sampler2D tile;
uniform vec2 scale;
in vec2 uv;
out vec4 value;
void main() {
  value = vec4(texture(tile, uv).rgb * scale.x + scale.y, 1.0);
}`;

/** A tile of shares into each channel: which of them is written, the colour mask says. */
export const COPY_SHARE = `#version 300 es
precision highp float;
uniform sampler2D tile;
in vec2 uv;
out vec4 value;
void main() {
  value = vec4(texture(tile, uv).r);
}`;

/** Flags lie over the cloth, dim and grey, so that one sees where they are. */
const reading: Record<Mode, string> = {
  color: 'vec4 map = texelFetch(color, at, 0); bool is_there = map.a > 0.0; vec3 seen = srgb(gain * map.rgb);',
  normal: 'vec4 map = texelFetch(normal, at, 0); bool is_there = map.a > 0.0; vec3 seen = map.rgb * 0.5 + 0.5;',
  relit: `vec4 map = texelFetch(normal, at, 0); vec4 rho = texelFetch(color, at, 0);
  bool is_there = map.a * rho.a > 0.0; vec3 seen = srgb(gain * rho.rgb * max(0.0, dot(map.xyz, light)));`,
  scalar: `vec4 map = texelFetch(scalar, at, 0); bool is_there = map.a > 0.0;
  vec3 seen = texture(heat, vec2((clamp((map.r - range.x) / (range.y - range.x), 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;`,
  flags: `vec4 map = texelFetch(normal, at, 0); vec4 rho = texelFetch(color, at, 0);
  bool is_there = map.a * rho.a > 0.0; vec3 lit = gain * rho.rgb * max(0.0, dot(map.xyz, light));
  vec3 seen = vec3(0.4 * srgb(vec3(dot(lit, vec3(0.2126, 0.7152, 0.0722)))).r);`,
};

const overFlags = `
  vec4 low = texelFetch(flags_low, at, 0); vec4 high = texelFetch(flags_high, at, 0);
  vec3 mixed = vec3(0.0); float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    mixed += low[i] * bit_colours[i] + high[i] * bit_colours[i + 4];
    sum += low[i] + high[i];
  }
  if (sum > 0.0) seen = mix(seen, mixed / sum, min(sum, 1.0) * 0.9);`;

/** Layers to what is seen, of which every `step`th pixel is shaded. */
export function shading(mode: Mode, has_flags: boolean): string {
  return `#version 300 es
precision highp float;
uniform sampler2D normal, color, scalar, heat, flags_low, flags_high;
uniform vec3 light, bit_colours[8];
uniform float gain;
uniform vec2 range;
uniform int step;
out vec4 value;
vec3 srgb(vec3 linear) {
  vec3 held = clamp(linear, 0.0, 1.0);
  return mix(12.92 * held, 1.055 * pow(held, vec3(1.0 / 2.4)) - 0.055, greaterThan(held, vec3(0.0031308)));
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) * step;
  ${reading[mode]}
  ${has_flags ? overFlags : ''}
  value = vec4(is_there ? seen : vec3(0.02), 1.0);
}`;
}
