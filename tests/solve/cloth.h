// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>

#include "core/base/vec.h"
#include "core/image/image.h"
#include "core/rig/lights.h"
#include "solve/bands/bands.h"
#include "solve/photographs/photographs.h"
#include "solver/reflectance/lobe.h"

// Cloths in closed form, photographed without noise.

namespace weft::solve {

struct Cloth {
  std::function<Vec3(int x, int y)> normal = [](int, int) { return Vec3{0, 0, 1}; };
  std::array<double, 3> albedo = {0.5, 0.5, 0.5};
  solver::Lobe lobe = {};  ///< seen from straight above; Lambert's: matt
  double lobe_share = 1;   ///< that reaches the readings: films change it
  std::function<bool(int x, int y)> is_matt = [](int, int) { return false; };     ///< there without the lobe
  std::function<double(int x, int y)> matt_share = [](int, int) { return 0.0; };  ///< of a pixel, else
  std::function<double(int x, int y)> roughening = [](int, int) { return 1.0; };  ///< alpha is times it
  std::function<double(int x, int y)> yarn = [](int, int) { return 0.0; };  ///< from the lobe's axis, radians
};

/// Ten distant lights: four at 35 degrees from the zenith and six at 62. Each is as bright as `rgb`.
DistantLights ten_lights(const std::array<double, 3>& rgb = {1, 1, 1});

/// A ridge and furrow every 24 pixels, 15 degrees at its steepest.
Vec3 wave(int x, int y);

/// Readings as they are.
Photographs developed(Size size, const Cloth& cloth, const DistantLights& lights = ten_lights());

/// Counts from black at 1000 to white at 61000, for one second at ISO 100; full from a reading of 0.98 on.
Photographs mosaics(Size size, const Cloth& cloth, const DistantLights& lights = ten_lights());
inline constexpr double kBlack = 1000, kRange = 60000;
RawFrame frame_of(Size size, const std::function<double(int x, int y)>& reading);

/// Whole maps of what a solve sends to its sink.
struct WholeMaps {
  explicit WholeMaps(Size size) : normal(size, 3), albedo(size, 3), status(size) {}
  Result<void> operator()(const MapBand& band);
  Vec3 normal_at(int x, int y) const { return {normal(x, y, 0), normal(x, y, 1), normal(x, y, 2)}; }

  Image<float> normal, albedo;
  Image<std::uint16_t> status;
  int rows = 0, albedo_rows = 0;  ///< that have come, in order
};

}  // namespace weft::solve
