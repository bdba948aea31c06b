// SPDX-License-Identifier: Apache-2.0
#include "solve/bands/realign.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "core/solve/solve_record.h"
#include "solve/levels/frame.h"
#include "tests/solve/cloth.h"
#include "tests/solve/wavy_maps.h"

namespace weft::solve {
namespace {

constexpr Size kWeaveFrame = {200, 141};

CameraModel camera_above() {
  return overhead_camera(kWeaveFrame, 600, 0.05);
}

// In the corner red looks 0.5 pixel farther in than green and blue 0.4 farther out.
LateralColor lens() {
  const double corner_px = shift_at_corner({.scale = 1}, camera_above());
  return {{.scale = -0.5 / corner_px}, {.scale = 0.4 / corner_px}};
}

// Dyed yarns 12.5 pixels wide and 15 degrees steep in both directions.
struct DyedWeave {
  static double across(double at) { return std::sin(2 * kPi * at / 25); }
  static Vec3 normal(double x, double y) {
    const double steepest = std::tan(radians(15));
    return normalized({steepest * across(2 * x), steepest * across(2 * y), 1});
  }
  static double albedo(int channel, double x, double y) {
    const double warp = 0.5 + 0.5 * across(x) * across(y);
    const double dyes[3][2] = {{0.6, 0.1}, {0.3, 0.35}, {0.08, 0.5}};
    return dyes[channel][0] * warp + dyes[channel][1] * (1 - warp);
  }
};

// Its photographs by a lens; photosites of `unlit` see nothing.
Photographs weave_behind(const std::optional<LateralColor>& lateral, Rect unlit = {}) {
  Photographs photographs = mosaics(kWeaveFrame, {});
  photographs.camera = camera_above();
  std::vector<RawFrame> frames;
  for (const DistantLight& light : ten_lights().lights) {
    frames.push_back(frame_of(kWeaveFrame, [&](int x, int y) {
      if (x >= unlit.x0 && x < unlit.x1 && y >= unlit.y0 && y < unlit.y1) return 1.0;
      const int c = CfaPattern().channel_at(x, y);
      const RadialShift shift = lateral ? lateral->of(static_cast<std::size_t>(c)) : RadialShift();
      const auto [dx, dy] = shift_at(shift, camera_above(), x, y);
      return DyedWeave::albedo(c, x + dx, y + dy) *
             std::max(0.0, dot(DyedWeave::normal(x + dx, y + dy), light.direction));
    }));
  }
  photographs.frames = Mosaics(std::move(frames), std::nullopt,
                               {.electrons_per_count = 2, .read_noise_counts = 3}, {1e6, 100});
  return photographs;
}

WholeMaps solved_frame(const Photographs& photographs, const TileOptions& tile = kSolveTile,
                       int threads = 2) {
  WholeMaps maps(photographs.size);
  const JobContext context = {.threads = threads};
  const auto facts = solve_frame(photographs, solver::method_of(solver::Level::kStandard), tile, context,
                                 [&](const MapBand& band) { return maps(band); });
  EXPECT_TRUE(facts) << facts.error().message();
  EXPECT_EQ(maps.rows, photographs.size.height);
  EXPECT_EQ(maps.albedo_rows, photographs.size.height);
  return maps;
}

// Mean errors over the frame: of normals at red and blue photosites, degrees; of red and blue albedo.
struct RedAndBlueErrors {
  double normal_deg = 0, albedo = 0;
};

RedAndBlueErrors errors_at_red_and_blue(const WholeMaps& maps) {
  RedAndBlueErrors sum;
  double sites = 0;
  for (int y = 0; y < kWeaveFrame.height; ++y) {
    for (int x = 0; x < kWeaveFrame.width; ++x) {
      for (const int c : {0, 2})
        sum.albedo += std::abs(static_cast<double>(maps.albedo(x, y, c)) - DyedWeave::albedo(c, x, y));
      if (CfaPattern().channel_at(x, y) == 1) continue;
      sum.normal_deg += angle_deg(maps.normal_at(x, y), DyedWeave::normal(x, y));
      ++sites;
    }
  }
  return {sum.normal_deg / sites, sum.albedo / static_cast<double>(2 * kWeaveFrame.pixels())};
}

bool are_same_maps(const Image<float>& a, const Image<float>& b) {
  for (int p = 0; p < a.planes(); ++p) {
    for (int y = 0; y < a.height(); ++y) {
      if (!std::equal(a.plane(p).row(y), a.plane(p).row(y) + a.width(), b.plane(p).row(y))) return false;
    }
  }
  return true;
}

bool are_same_maps(const WholeMaps& a, const WholeMaps& b) {
  return are_same_maps(a.normal, b.normal) && are_same_maps(a.albedo, b.albedo);
}

TEST(LateralColor, IsTakenOutOfADyedWeave) {
  const RedAndBlueErrors none = errors_at_red_and_blue(solved_frame(weave_behind({})));
  Photographs photographs = weave_behind(lens());
  const RedAndBlueErrors without = errors_at_red_and_blue(solved_frame(photographs));
  photographs.lateral = lens();
  const RedAndBlueErrors with = errors_at_red_and_blue(solved_frame(photographs));
  std::printf(
      "normals at red and blue photosites, mean error in degrees: %.3f with lateral colour, %.3f taken out, "
      "%.3f without any\nalbedo of red and blue, mean error: %.5f, %.5f, %.5f\n",
      without.normal_deg, with.normal_deg, none.normal_deg, without.albedo, with.albedo, none.albedo);
  EXPECT_GT(without.normal_deg, 1);
  EXPECT_LT(with.normal_deg, 0.25);
  EXPECT_LT(with.albedo - none.albedo, 0.2 * (without.albedo - none.albedo));
}

TEST(LateralColor, GivesTheSameWhateverTheTilesAndThreads) {
  Photographs photographs = weave_behind(lens());
  photographs.lateral = lens();
  const WholeMaps maps = solved_frame(photographs);
  EXPECT_TRUE(are_same_maps(solved_frame(photographs, {.width = 64, .height = 16}, 3), maps));
  EXPECT_TRUE(are_same_maps(solved_frame(photographs, {.width = 192, .height = 64}, 1), maps));
}

TEST(LateralColor, ChangesNothingWhereNoColourLooksAside) {
  Photographs photographs = weave_behind({});
  const WholeMaps maps = solved_frame(photographs);
  photographs.lateral = LateralColor();
  EXPECT_TRUE(are_same_maps(solved_frame(photographs), maps));
}

TEST(LateralColor, LeavesWhatHasNoSolutionAsItIs) {
  const Rect full = {90, 0, 96, 6};
  Photographs photographs = weave_behind(lens(), full);
  const WholeMaps before = solved_frame(photographs);
  photographs.lateral = lens();
  const WholeMaps after = solved_frame(photographs);
  for (int y = 0; y < kWeaveFrame.height; ++y) {
    for (int x = 0; x < kWeaveFrame.width; ++x) {
      ASSERT_EQ(after.status(x, y) & kNoSolution, before.status(x, y) & kNoSolution) << x << ", " << y;
      if (before.status(x, y) & kNoSolution) {
        EXPECT_EQ(after.normal_at(x, y), Vec3(0, 0, 1));
      }
      ASSERT_TRUE(std::isfinite(after.normal(x, y, 0))) << x << ", " << y;
    }
  }
  EXPECT_NE(before.status(92, 2) & kNoSolution, 0);
}

// A shift of over two pixels brings the status of the next photosite of the colour with it.
TEST(LateralColor, BringsStatusAndResidualFromWhereTheyWereMeasured) {
  WavyMaps maps;
  const Size size = WavyMaps::kSize;
  maps.status(10, 10) = kShadowed;  // red in RGGB
  CameraModel far_axis = overhead_camera(size, 600, 0.05);
  far_axis.cx = 10 + 250, far_axis.cy = 10;
  const LateralColor lateral = {.red = {.scale = 0.008}, .blue = {}};  // 2 pixels to the left at x = 10
  std::vector<std::pair<int, int>> shadowed;
  float residual = 0;
  const BandSink sink = [&](const MapBand& band) -> Result<void> {
    for (int y = 0; y < band.rows.height(); ++y) {
      for (int x = 0; x < size.width; ++x) {
        if (band.status(x, y) & kShadowed) shadowed.emplace_back(x, band.rows.y0 + y);
      }
    }
    if (band.rows.y0 <= 10 && band.rows.y1 > 10) residual = band.residual(8, 10 - band.rows.y0);
    return {};
  };
  Realign realign(size, {}, lateral, far_axis, 1, sink);
  maps.feed(realign, 64);
  EXPECT_EQ(shadowed, (std::vector<std::pair<int, int>>{{8, 10}}));
  EXPECT_EQ(residual, 10);
}

TEST(LateralColor, GivesTheSameWhateverTheBands) {
  const WavyMaps maps;
  const auto aligned = [&](int height) {
    std::vector<float> all;
    const BandSink sink = [&](const MapBand& band) -> Result<void> {
      for (int y = 0; y < band.rows.height(); ++y) {
        for (const View<const float>& map : {band.normal[0], band.normal[2], band.albedo[0], band.albedo[2],
                                             band.sigma_albedo[0], band.sigma_normal_deg, band.residual})
          all.insert(all.end(), map.row(y), map.row(y) + map.width());
      }
      return {};
    };
    Realign realign(WavyMaps::kSize, {}, lens(), camera_above(), 2, sink);
    maps.feed(realign, height);
    return all;
  };
  const std::vector<float> whole = aligned(WavyMaps::kSize.height);
  ASSERT_EQ(whole.size(), 7 * static_cast<std::size_t>(WavyMaps::kSize.pixels()));
  for (const int height : {64, 16, 1}) EXPECT_EQ(aligned(height), whole) << height << " rows a band";
}

}  // namespace
}  // namespace weft::solve
