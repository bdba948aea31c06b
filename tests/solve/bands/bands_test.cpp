// SPDX-License-Identifier: Apache-2.0
#include "solve/bands/bands.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "core/solve/solve_record.h"
#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

constexpr Size kBandedSize = {96, 150};  // two whole bands and a part of one
const Cloth kWaves = {.normal = wave, .albedo = {0.3, 0.5, 0.4}};

WholeMaps solved(const Photographs& photographs, const TileOptions& tile = kSolveTile, int threads = 1) {
  WholeMaps maps(photographs.size);
  const auto ok =
      solve_bands(photographs, *solver::fast_method(), tile, {.threads = threads}, std::ref(maps), {});
  EXPECT_TRUE(ok) << ok.error().message();
  return maps;
}

void expect_waves(const WholeMaps& maps, double most_deg) {
  EXPECT_EQ(maps.rows, kBandedSize.height);
  EXPECT_EQ(maps.albedo_rows, kBandedSize.height);
  for (int y = 0; y < kBandedSize.height; ++y) {
    for (int x = 0; x < kBandedSize.width; ++x) {
      ASSERT_LT(angle_deg(maps.normal_at(x, y), wave(x, y)), most_deg) << x << ' ' << y;
      for (int c = 0; c < 3; ++c) {
        ASSERT_NEAR(maps.albedo(x, y, c), kWaves.albedo[static_cast<std::size_t>(c)], 1e-3)
            << x << ' ' << y << ", channel " << c;
      }
    }
  }
}

TEST(SolveBands, OfMosaicsGiveNormalsAndDemosaicedAlbedoOfTheWholeFrame) {
  expect_waves(solved(mosaics(kBandedSize, kWaves)), 0.01);
}

TEST(SolveBands, OfDevelopedPhotographsGiveTheSame) {
  expect_waves(solved(developed(kBandedSize, kWaves)), 1e-3);
}

TEST(SolveBands, DoNotDependOnTilesOrThreads) {
  const Photographs photographs = mosaics(kBandedSize, kWaves);
  const WholeMaps whole = solved(photographs), tiled = solved(photographs, {.width = 64, .height = 7}, 2);
  for (int y = 0; y < kBandedSize.height; ++y) {
    for (int x = 0; x < kBandedSize.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        ASSERT_EQ(whole.normal(x, y, c), tiled.normal(x, y, c)) << x << ' ' << y;
        ASSERT_EQ(whole.albedo(x, y, c), tiled.albedo(x, y, c)) << x << ' ' << y;
      }
    }
  }
}

TEST(SolveBands, MarkThePhotositesThatWereReplaced) {
  Photographs photographs = mosaics(kBandedSize, kWaves);
  photographs.mosaics()->replaced = {{3, 17}, {149, 95}};
  const WholeMaps maps = solved(photographs);
  EXPECT_TRUE(maps.status(17, 3) & kInvalidReading);
  EXPECT_TRUE(maps.status(95, 149) & kInvalidReading);
  EXPECT_FALSE(maps.status(16, 3) & kInvalidReading);
}

TEST(SolveBands, CountEveryPixel) {
  solver::SolveTally tally;
  const auto nowhere = [](const MapBand&) { return Result<void>(); };
  ASSERT_TRUE(solve_bands(mosaics(kBandedSize, kWaves), *solver::fast_method(), kSolveTile, {.threads = 2},
                          nowhere, {.tally = &tally}));
  EXPECT_EQ(tally.by_kernel + tally.by_normal_equations + tally.by_qr + tally.by_svd, kBandedSize.pixels());
}

TEST(SolveBands, EndWithTheErrorOfTheirSink) {
  int bands = 0;
  const auto full = [&](const MapBand&) -> Result<void> {
    ++bands;
    return Error{ErrorKind::kInputOutput, "disk is full", "", "", ""};
  };
  const auto ok =
      solve_bands(mosaics(kBandedSize, kWaves), *solver::fast_method(), kSolveTile, {.threads = 1}, full);
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().kind, ErrorKind::kInputOutput);
  EXPECT_EQ(bands, 1) << "nothing is asked of a sink that failed";
}

TEST(SolveBands, StopOnRequest) {
  std::stop_source stop;
  stop.request_stop();
  WholeMaps maps(kBandedSize);
  const auto ok = solve_bands(mosaics(kBandedSize, kWaves), *solver::fast_method(), kSolveTile,
                              {.threads = 1, .stop = stop.get_token()}, std::ref(maps));
  ASSERT_FALSE(ok);
  EXPECT_EQ(ok.error().kind, ErrorKind::kInterrupted);
}

}  // namespace
}  // namespace weft::solve
