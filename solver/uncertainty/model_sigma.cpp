// SPDX-License-Identifier: Apache-2.0
#include "solver/uncertainty/model_sigma.h"

#include <algorithm>
#include <cmath>

namespace weft::solver {
namespace {

// Fitted to the tuning set (bench/accuracy/accuracy_scenes.h). Of a preview: what its pixels' four photosites
// differ by, over the steps from pixel to pixel. On a yarn they lie a quarter of a step to both sides. Where
// normals meet on both sides the pixel itself is mixed from two yarns; where they meet on one side, what
// mixes is mostly the neighbour.
constexpr float kOnYarn = 0.3F, kMixed = 0.88F, kBesideMixed = 0.09F;

}  // namespace

ResidualNoise residual_noise(const LightField& field, const NoiseModel& noise, int x, int y, int c) {
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
  left.photons = {static_cast<float>(photons.x), static_cast<float>(photons.y),
                  static_cast<float>(photons.z)};
  left.floor = static_cast<float>(floor);
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
  const double copies = std::max(1.0, n / kIndependentLights);
  return degrees(std::sqrt(copies * across * n / (n - 3)));
}

float within_pixel2(float step_before, float step_after) {
  const auto square = [](float x) { return x * x; };
  const float most = std::max(step_before, step_after), least = std::min(step_before, step_after);
  const float across = (step_before + step_after) / 2;
  if (least >= 0) return square(kOnYarn * across);
  if (most < 0) return square(kMixed * across);
  return square(kOnYarn * most) + square(kBesideMixed * least);
}

}  // namespace weft::solver
