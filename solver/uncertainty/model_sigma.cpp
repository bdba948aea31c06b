// SPDX-License-Identifier: Apache-2.0
#include "solver/uncertainty/model_sigma.h"

#include <algorithm>
#include <cmath>

namespace weft::solver {
namespace {

// All constants are fitted to the tuning set (bench/accuracy/scenes.h), over all levels at once.

// Degrees by which light from the cloth turns a normal, over albedo and square of the slope: a slope sees as
// much of the cloth as it does not see of the sky. Flanks, steeper than what is around them, are turned by
// more than crests and furrows: by as much as their slope's square is over that around, to a limit.
constexpr float kBounced_deg = 9, kMostOfFlank = 4;
// What is left of it where it was taken out, over albedo and slope: the relief is no better known than the
// normals.
constexpr float kBouncesLeft_deg = 2.3F;
// Degrees over the share of pixels with shadowed readings and the slope: the edge of a shadow passes for
// light.
constexpr float kShadowed_deg = 1.5F;
// What a misfit turns, over what it would if it were independent from light to light: upright, and more of it
// on a slope, since a ring of lights has its highlights on all sides of an upright cloth. A robust start has
// left out the readings that pull, and their residuals still count.
struct Pull {
  float upright, on_slope;
  float at(float slope) const { return upright + on_slope * slope; }
};
constexpr Pull kHere = {0.35F, 0.7F}, kAround = {0.38F, 0.2F};
constexpr Pull kHereOfRobust = {0.15F, 0.05F}, kAroundOfRobust = {0.06F, 0.12F};
// Of a preview: what its pixels' four photosites differ by, over the steps from pixel to pixel. On a yarn
// they lie a quarter of a step to both sides. Where normals meet on both sides the pixel itself is mixed from
// two yarns; where they meet on one side, what mixes is mostly the neighbour.
constexpr float kOnYarn = 0.3F, kMixed = 0.88F, kBesideMixed = 0.09F;
// Of a preview: degrees over the cube of the slope around, as light that does not reach a slope is taken for
// little light, and what is added to the albedo, as pale cloth fills it with light of its own.
constexpr float kUnmasked_deg = 57, kUnmaskedOfBlack = 1.1F;
// Lighter cloth is as light as this.
constexpr float kMostAlbedo = 1.2F;
// Divides nothing by nothing.
constexpr float kLeastSlope2 = 1e-6F;

}  // namespace

ResidualNoise ResidualNoise::at(const LightField& field, const NoiseModel& noise, int x, int y, int c) {
  ResidualNoise left;
  const auto lights = static_cast<double>(field.count());
  const double share = std::max(lights - 3, 0.0) / (lights * lights);
  Vec3 photons;
  double floor = 0;
  for (std::size_t k = 0; k < field.count(); ++k) {
    const LightField::Light light = field.at(k, c, x, y);
    if (!(light.strength > 0)) continue;
    photons = photons + (share * noise.per_reading / light.strength) * light.direction;
    floor += share * (noise.floor + noise.shared) / (light.strength * light.strength);
  }
  left.photons_ = {static_cast<float>(photons.x), static_cast<float>(photons.y),
                   static_cast<float>(photons.z)};
  left.floor_ = static_cast<float>(floor);
  return left;
}

double degrees_a_residual(const LightField& field, int x, int y) {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, n = 0;
  for (std::size_t k = 0; k < field.count(); ++k) {
    const LightField::Light light = field.at(k, 1, x, y);
    if (!(light.strength > 0)) continue;
    const Vec3 l = light.direction;
    xx += l.x * l.x, xy += l.x * l.y, xz += l.x * l.z;
    yy += l.y * l.y, yz += l.y * l.z, zz += l.z * l.z;
    ++n;
  }
  const double det = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  if (n < 4 || !(det > 0)) return 0;
  const double across = (yy * zz - yz * yz + xx * zz - xz * xz) / det;
  return degrees(std::sqrt(across * n / (n - 3)));
}

float within_pixel2(float step_before, float step_after) {
  const auto square = [](float x) { return x * x; };
  const float most = std::max(step_before, step_after), least = std::min(step_before, step_after);
  const float across = (step_before + step_after) / 2;
  if (least >= 0) return square(kOnYarn * across);
  if (most < 0) return square(kMixed * across);
  return square(kOnYarn * most) + square(kBesideMixed * least);
}

float model_sigma_deg(const ModelEvidence& evidence, double degrees_a_residual, const ModelTraits& traits) {
  const float slope = std::sqrt(evidence.slope2), albedo = std::min(evidence.albedo, kMostAlbedo);
  const float flank =
      std::min(evidence.slope2 / std::max(evidence.slope2_around, kLeastSlope2), kMostOfFlank);
  float bounced = kBounced_deg * albedo * evidence.slope2 * flank;
  if (traits.bounces_are_out) bounced = std::min(bounced, kBouncesLeft_deg * albedo * slope);
  const float shadowed = kShadowed_deg * evidence.shadowed * slope;
  const float here = (traits.is_robust ? kHereOfRobust : kHere).at(slope),
              around = (traits.is_robust ? kAroundOfRobust : kAround).at(slope),
              scale = static_cast<float>(degrees_a_residual);
  float sum2 = bounced * bounced + shadowed * shadowed +
               scale * scale * (here * here * evidence.misfit2 + around * around * evidence.misfit2_around);
  if (traits.is_half) {
    const float unmasked = kUnmasked_deg * (kUnmaskedOfBlack + albedo) * evidence.slope2_around *
                           std::sqrt(evidence.slope2_around);
    sum2 += unmasked * unmasked;
  }
  return std::min(std::sqrt(sum2), 180.0F);
}

}  // namespace weft::solver
