// SPDX-License-Identifier: Apache-2.0
// A cloth as a material: on a ball or flat, under one distant lamp within even surroundings. The lamp is as strong as
// that of the viewer: white cloth that faces it is 1. Equations as in glTF 2.0, appendix B, and KHR_materials_sheen.

/**
 * `scalars` are occlusion, roughness, opacity, f0; `sheens` colour and roughness; `tints` f0 of each channel over f0.
 * What is not mapped is typed.
 */
export const CLOTH = `#version 300 es
precision highp float;
uniform sampler2D normal, color, scalars, sheens, tints, shares;
uniform vec2 canvas, cloth_mm, cells;
uniform float px_per_mm, radius_mm, slant, gain, brightness, surroundings, metallic, step, mapped_color, mapped_tint;
uniform bool is_endless;
uniform vec3 light, typed_color, typed_tint;
uniform vec4 typed, mapped, typed_sheen, mapped_sheen;
out vec4 value;
const float PI = 3.14159265;
vec3 srgb(vec3 linear) {
  vec3 held = clamp(linear, 0.0, 1.0);
  return mix(12.92 * held, 1.055 * pow(held, vec3(1.0 / 2.4)) - 0.055, greaterThan(held, vec3(0.0031308)));
}
float ggx(float nl, float nv, float nh, float squared) {
  float d = nh * nh * (squared - 1.0) + 1.0;
  float v = 0.5 / (nl * sqrt(nv * nv * (1.0 - squared) + squared) + nv * sqrt(nl * nl * (1.0 - squared) + squared));
  return squared / (PI * d * d) * v;
}
float sheen(float nl, float nv, float nh, float roughness) {
  float inverse = 1.0 / max(roughness * roughness, 1e-3);
  return (2.0 + inverse) * pow(max(1.0 - nh * nh, 0.0), 0.5 * inverse) / (2.0 * PI) / (4.0 * (nl + nv - nl * nv));
}
void main() {
  vec2 at = (gl_FragCoord.xy * step - 0.5 * canvas) / px_per_mm;
  vec3 right = vec3(1.0, 0.0, 0.0), up = vec3(0.0, cos(slant), -sin(slant)), out_of = vec3(0.0, sin(slant), cos(slant));
  vec2 place = vec2(at.x, at.y / cos(slant));
  bool is_there = true;
  if (radius_mm > 0.0) {
    float far = length(at) / radius_mm;
    is_there = far < 1.0;
    far = min(far, 0.9999);
    vec2 away = far > 1e-6 ? normalize(at) : vec2(1.0, 0.0);
    vec3 along = vec3(sqrt(1.0 - far * far) * away, -far), across = vec3(-away.y, away.x, 0.0);
    out_of = vec3(far * away, sqrt(1.0 - far * far));
    right = away.x * along - away.y * across;
    up = away.y * along + away.x * across;
    place = radius_mm * asin(far) * away;
  }
  vec2 uv = vec2(place.x, -place.y) / cloth_mm + 0.5 * cells;
  vec4 facing = texture(normal, uv), rho = texture(color, uv);
  vec4 scalar = mix(typed, texture(scalars, uv), mapped), soft = mix(typed_sheen, texture(sheens, uv), mapped_sheen);
  bool is_on = is_endless || (all(greaterThanEqual(uv, vec2(0.0))) && all(lessThanEqual(uv, cells)));
  float mean = clamp(length(facing.xyz), 0.05, 1.0);
  vec3 n = normalize(facing.x * right + facing.y * up + facing.z * out_of);
  vec3 albedo = mix(typed_color, gain * rho.rgb, mapped_color);
  float roughness = clamp(scalar.g, 0.03, 1.0);
  float squared = min(pow(roughness, 4.0) + 2.0 * (1.0 - mean * mean) / (mean * (3.0 - mean * mean)), 1.0);
  vec3 h = normalize(light + vec3(0.0, 0.0, 1.0));
  float nl = max(dot(n, light), 1e-4), nv = clamp(n.z, 0.02, 1.0), nh = clamp(dot(n, h), 0.0, 1.0);
  vec3 shine = scalar.a * mix(typed_tint, texture(tints, uv).rgb, mapped_tint);
  vec3 f0 = mix(shine, albedo, metallic), fresnel = f0 + (1.0 - f0) * pow(1.0 - h.z, 5.0);
  vec3 matt = albedo * (1.0 - metallic);
  vec3 from = texture(shares, vec2(nv, pow(squared, 0.25))).rgb;
  float soft_seen = texture(shares, vec2(nv, soft.a)).b, soft_lit = texture(shares, vec2(nl, soft.a)).b;
  float most = max(soft.r, max(soft.g, soft.b)), below = 1.0 - most * max(soft_seen, soft_lit);
  vec3 lit = below * (matt * (1.0 - fresnel) + PI * ggx(nl, nv, nh, squared) * fresnel) + PI * soft.rgb * sheen(nl, nv, nh, soft.a);
  vec3 mirrored = f0 * from.r + from.g;
  vec3 sky = (1.0 - most * soft_seen) * (matt * (1.0 - mirrored) + mirrored) + soft.rgb * soft_seen;
  float sun = dot(n, light) > 0.0 ? nl * smoothstep(-0.02, 0.05, dot(out_of, light)) : 0.0;
  vec3 seen = srgb(brightness * (sun * lit + surroundings * scalar.r * sky));
  value = vec4(is_there && is_on ? mix(vec3(0.02), seen, clamp(scalar.b, 0.0, 1.0)) : vec3(0.02), 1.0);
}`;
