// SPDX-License-Identifier: Apache-2.0
#include "pipeline/deblur.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace weft::pipeline {
namespace {

constexpr Size kCloth = {150, 131};
constexpr PointSpread kLens = {{0.6, 0.6, 0.6}};

// WavyMaps of a wavy grey cloth: normal, albedo, sigma of the albedo, sigma of the normal, residual.
struct WavyMaps {
  Image<float> planes{kCloth, 11};
  Image<std::uint16_t> status{kCloth};

  WavyMaps() {
    for (int y = 0; y < kCloth.height; ++y) {
      for (int x = 0; x < kCloth.width; ++x) {
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

  // Normals, residual and status of `rows`, the rest of `albedo_rows`.
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
};

// X of the normals as they come out, from bands of `height` rows whose albedo lags by 2.
std::vector<float> sharpened(const WavyMaps& maps, int height) {
  std::vector<float> x;
  int next_row = 0;
  const BandSink sink = [&](const MapBand& band) -> Result<void> {
    EXPECT_EQ(band.rows.y0, next_row);
    EXPECT_EQ(band.rows, band.albedo_rows);
    next_row = band.rows.y1;
    for (int y = 0; y < band.rows.height(); ++y) {
      EXPECT_EQ(band.residual(0, y), static_cast<float>(band.rows.y0 + y));
      x.insert(x.end(), band.normal[0].row(y), band.normal[0].row(y) + kCloth.width);
    }
    return {};
  };
  Deblur deblur(kCloth, {1, {}}, kLens, 2, sink);
  int late = 0;
  for (int y0 = 0; y0 < kCloth.height; y0 += height) {
    const int y1 = std::min(y0 + height, kCloth.height);
    const int to = y1 == kCloth.height ? y1 : std::max(y1 - 2, 0);
    EXPECT_TRUE(deblur.put(maps.band({0, y0, kCloth.width, y1}, {0, late, kCloth.width, to})));
    late = to;
  }
  EXPECT_EQ(next_row, kCloth.height);
  EXPECT_GT(deblur.facts().mean_share, 0.5);
  return x;
}

TEST(Deblur, GivesTheSameWhateverTheBands) {
  const WavyMaps maps;
  const std::vector<float> whole = sharpened(maps, kCloth.height);
  for (const int height : {64, 16, 1}) EXPECT_EQ(sharpened(maps, height), whole) << height << " rows a band";
}

}  // namespace
}  // namespace weft::pipeline
