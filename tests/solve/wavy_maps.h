// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/image/image.h"
#include "solve/bands/bands.h"

namespace weft::solve {

/// Maps of a wavy grey cloth: normal, albedo, sigma of the albedo, sigma of the normal, residual.
struct WavyMaps {
  static constexpr Size kSize = {150, 131};
  Image<float> planes{kSize, 11};
  Image<std::uint16_t> status{kSize};

  WavyMaps() {
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const double slope = 0.3 * std::sin(0.8 * x) * std::cos(0.7 * y);
        planes(x, y, 0) = static_cast<float>(slope);
        planes(x, y, 2) = static_cast<float>(std::sqrt(1 - slope * slope));
        for (int c = 3; c < 6; ++c) planes(x, y, c) = 0.5F;
        for (int c = 6; c < 9; ++c) planes(x, y, c) = 0.001F;
        planes(x, y, 9) = 0.1F;
        planes(x, y, 10) = static_cast<float>(y);
      }
    }
  }

  /// Normals, residual and status of `rows`, the rest of `albedo_rows`.
  MapBand band(Rect rows, Rect albedo_rows) const {
    const auto of = [&](int p) { return planes.plane(p).crop(rows); };
    const auto late = [&](int p) { return planes.plane(p).crop(albedo_rows); };
    MapBand band;
    band.rows = rows;
    band.normal = {of(0), of(1), of(2)};
    band.residual = of(10);
    band.status = status.plane().crop(rows);
    band.albedo_rows = albedo_rows;
    band.albedo = {late(3), late(4), late(5)};
    band.sigma_albedo = {late(6), late(7), late(8)};
    band.sigma_normal_deg = late(9);
    return band;
  }

  /// Gives all to a step in bands of `height` rows whose albedo lags by 2.
  template <typename Step>
  void feed(Step& step, int height) const {
    int late = 0;
    for (int y0 = 0; y0 < kSize.height; y0 += height) {
      const int y1 = std::min(y0 + height, kSize.height);
      const int to = y1 == kSize.height ? y1 : std::max(y1 - 2, 0);
      EXPECT_TRUE(step.put(band({0, y0, kSize.width, y1}, {0, late, kSize.width, to})));
      late = to;
    }
  }
};

}  // namespace weft::solve
