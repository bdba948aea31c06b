// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/tile_reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

constexpr Size kReadSize = {128, 16};
constexpr Rect kTile = {64, 4, 128, 12};
constexpr TileOptions kTiles = {.width = 64, .height = 8};

TEST(TileReader, ShowsDevelopedPhotographsWhereTheyAre) {
  const Photographs photographs = developed(kReadSize, {});
  TileReader reader(photographs, kTiles);
  const solver::TileInput input = reader.read(kTile);
  EXPECT_EQ(input.planes, 3);
  EXPECT_FALSE(input.noise);
  ASSERT_EQ(input.readings.size(), 30U);
  EXPECT_EQ(input.readings[3 * 7 + 2].row(0),
            std::get<Developed>(photographs.frames).rgb[7].plane(2).row(4) + 64);
}

TEST(TileReader, ReadsAMosaicAsItsLightAndAlbedoPredict) {
  const Photographs photographs = mosaics(kReadSize, {.albedo = {0.2, 0.4, 0.8}});
  TileReader reader(photographs, kTiles);
  const solver::TileInput input = reader.read(kTile);
  EXPECT_EQ(input.planes, 1);
  EXPECT_EQ(input.noise->floor, photographs.noise()->floor);
  const double cosine = std::cos(radians(35));
  EXPECT_NEAR(input.readings[0](0, 0), 0.2 * cosine, 1 / kRange) << "red";
  EXPECT_NEAR(input.readings[0](1, 0), 0.4 * cosine, 1 / kRange) << "green";
  EXPECT_NEAR(input.readings[0](1, 1), 0.8 * cosine, 1 / kRange) << "blue";
}

TEST(TileReader, DemosaicsAnEvenClothUnderColouredLightToItsOwnReadings) {
  const DistantLights lights = ten_lights({0.5, 1, 0.25});
  const Photographs photographs = mosaics(kReadSize, {.albedo = {0.6, 0.6, 0.6}}, lights);
  TileReader reader(photographs, kTiles, ReadAs::kRgb);
  const solver::TileInput input = reader.read(kTile);
  EXPECT_EQ(input.planes, 3);
  EXPECT_FALSE(input.noise) << "it holds for photosites";
  for (std::size_t k = 0; k < 10; ++k) {
    const DistantLight& light = lights.lights[k];
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(input.readings[3 * k + c](9, 5), 0.6 * light.irradiance_rgb[c] * light.direction.z, 3e-5)
          << "light " << k << ", channel " << c;
    }
  }
}

TEST(Mosaics, JoinABracketWhereTheLitShotIsFull) {
  Photographs photographs = mosaics(kReadSize, {});
  Mosaics& all = *photographs.mosaics();
  all.frames[0] = frame_of(kReadSize, [](int x, int) { return x < 70 ? 1 : 0.4; });
  RawFrame shorter = frame_of(kReadSize, [](int x, int) { return x < 70 ? 0.25 * 1.6 : 0.25 * 0.4; });
  const Radiometry radiometry(shorter, nullptr, all.response, {0.25e6, 100});
  all.brackets.resize(10);
  all.brackets[0].push_back({std::move(shorter), radiometry});
  Image<float> scratch({64, 8});
  const auto readings = readings_of(photographs.frames, 0, kTile, scratch.plane());
  ASSERT_EQ(readings.size(), 1U);
  EXPECT_NEAR(readings[0](2, 3), 1.6, 1e-4) << "from the bracket alone";
  EXPECT_NEAR(readings[0](30, 3), 0.4, 1e-4);
  EXPECT_NEAR(readings_of(photographs.frames, 1, kTile, scratch.plane())[0](2, 3),
              0.5 * std::cos(radians(35)), 1e-4);
}

}  // namespace
}  // namespace weft::solve
