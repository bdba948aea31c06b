// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/image/image.h"
#include "core/rig/camera.h"
#include "core/rig/light_field.h"
#include "core/rig/lights.h"
#include "solver/in_double/pixel.h"
#include "solver/method.h"

namespace weft::test {

/// Four LEDs at 35 degrees from the zenith and six at 62, 600 mm from the table's centre and aimed at it.
NearLights ten_leds(double mu = 1);

/// Repeatable numbers in [0, 1): splitmix64 (Steele et al., OOPSLA 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double uniform();
  double normal();

 private:
  std::uint64_t state_;
};

/// A unit vector up to `most_deg` from (0, 0, 1).
Vec3 random_normal(Random& random, double most_deg);

/// What the light falling on one pixel makes of the pixel's true surface.
struct Truth {
  Vec3 normal;
  std::array<double, 3> albedo;
};

/// Readings of one tile under a field, by the model of core/rig/light_field.h, and room for what a method
/// returns.
class Trial {
 public:
  Trial(const LightField& field, Rect tile, int planes, const std::function<Truth(int x, int y)>& truth);
  void add_noise(const NoiseModel& noise, std::uint64_t seed);
  void solve(const solver::Method& method, const std::optional<NoiseModel>& noise = std::nullopt);

  /// Degrees between the solved and the true normal at a pixel of the tile.
  double error_deg(int x, int y) const;
  Vec3 normal(int x, int y) const;
  /// What light and readings of a pixel are, for the slow truth.
  std::vector<solver::PixelRow> rows(int x, int y) const;
  View<float> reading(std::size_t light, int plane = 0) {
    return readings_.plane(static_cast<int>(light) * planes_ + plane);
  }

  CfaPattern cfa;
  Image<float> normals, albedo, sigma_albedo, sigma_normal_deg, residual;
  Image<std::uint16_t> status;

 private:
  const LightField* field_;
  Rect tile_;
  int planes_;
  std::function<Truth(int, int)> truth_;
  Image<float> readings_;
};

}  // namespace weft::test
