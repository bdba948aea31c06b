// SPDX-License-Identifier: Apache-2.0
#include "solve/bands/deblur.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/solve/wavy_maps.h"

namespace weft::solve {
namespace {

constexpr Size kCloth = WavyMaps::kSize;
constexpr PointSpread kLens = {{0.6, 0.6, 0.6}};

// X of the normals as they come out, from bands of `height` rows.
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
  maps.feed(deblur, height);
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
}  // namespace weft::solve
