// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "bench/accuracy/accuracy.h"

namespace weft::bench {
namespace {

// A contender that knows the truth and spoils it: turns every normal by some degrees and makes the albedo
// wrong by `bias` + `leak` (openness - 1/2).
Contender spoiler(double turn_deg, double bias, double leak) {
  return {"spoiler", [=](const ClothPatch& patch, int, SolvedMaps& maps) -> Result<void> {
            const CfaPattern cfa;
            for (int y = 0; y < patch.size().height; ++y) {
              for (int x = 0; x < patch.size().width; ++x) {
                const Vec3 n = {patch.normal(x, y, 0), patch.normal(x, y, 1), patch.normal(x, y, 2)};
                const Vec3 aside = normalized(cross(n, {1, 0, 0}));
                const Vec3 turned = std::cos(radians(turn_deg)) * n + std::sin(radians(turn_deg)) * aside;
                maps.normal(x, y, 0) = static_cast<float>(turned.x);
                maps.normal(x, y, 1) = static_cast<float>(turned.y);
                maps.normal(x, y, 2) = static_cast<float>(turned.z);
                const double wrong = 1 + bias + leak * (patch.openness(x, y) - 0.5);
                maps.albedo(x, y) = static_cast<float>(wrong * patch.albedo(x, y, cfa.channel_at(x, y)));
              }
            }
            return {};
          }};
}

// A patch with all that scoring looks at: level cloth of albedo 1/2, openness rising from left to right.
BoundedPatches plain_patch(float bound_deg) {
  const Size size = {64, 48};
  ClothPatch patch;
  patch.photographs.size = size;
  RawFrame frame;
  frame.counts = Image<std::uint16_t>({2, 2});
  frame.white = 1000;
  std::vector<RawFrame> frames;
  frames.push_back(std::move(frame));
  patch.photographs.frames = solve::Mosaics(std::move(frames), std::nullopt, Response{2, 1, {}}, {1000, 100});
  patch.normal = Image<float>(size, 3);
  patch.albedo = Image<float>(size, 3);
  patch.openness = Image<float>(size);
  BoundedPatches scene;
  scene.bounds.emplace_back(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      patch.normal(x, y, 2) = 1;
      for (int c = 0; c < 3; ++c) patch.albedo(x, y, c) = 0.5F;
      // By halves about the middle of what is measured.
      patch.openness(x, y) = 0.5F + static_cast<float>(2 * x + 1 - size.width) / 128;
      scene.bounds[0](x, y) = bound_deg;
    }
  }
  scene.patches.push_back(std::move(patch));
  return scene;
}

TEST(AccuracyScore, OfATurnedNormalIsTheTurnAndItsRatioToTheBound) {
  const auto row = score(spoiler(2, 0, 0), plain_patch(0.5F), 1);
  ASSERT_TRUE(row.has_value()) << row.error().message();
  EXPECT_NEAR(number(*row, "mean_deg"), 2, 1e-4);
  EXPECT_NEAR(number(*row, "p95_deg"), 2, 1e-4);
  EXPECT_NEAR(number(*row, "ratio_to_bound"), 4, 1e-3);
  EXPECT_NEAR(number(*row, "albedo_mean_rel"), 0, 1e-6);
  EXPECT_NEAR(number(*row, "leak"), 0, 1e-5);
}

TEST(AccuracyScore, TellsLeakFromBias) {
  const auto row = score(spoiler(0, 0.04, -0.06), plain_patch(1), 1);
  ASSERT_TRUE(row.has_value()) << row.error().message();
  EXPECT_NEAR(number(*row, "albedo_bias_rel"), 0.04, 1e-5);
  EXPECT_NEAR(number(*row, "leak"), -0.06, 1e-5);
  EXPECT_NEAR(number(*row, "albedo_mean_rel"), 0.04, 1e-5) << "no error changes its sign";
}

TEST(AccuracyScore, CountsANormalThatIsNoNumberAsUnknown) {
  const auto row = score(spoiler(std::numeric_limits<double>::quiet_NaN(), 0, 0), plain_patch(1), 1);
  ASSERT_TRUE(row.has_value());
  EXPECT_EQ(number(*row, "mean_deg"), 180);
}

TEST(AccuracyScore, PassesOnWhatStopsAContender) {
  const Contender broken = {"broken", [](const ClothPatch&, int, SolvedMaps&) -> Result<void> {
                              return Error{ErrorKind::kTryAgain, "no", "", "", ""};
                            }};
  EXPECT_FALSE(score(broken, plain_patch(1), 1).has_value());
}

TEST(MeanRow, AveragesNumbersAndKeepsTheRest) {
  const Json a = {{"method", "fast"}, {"mean_deg", 1.0}, {"threads", 2}};
  const Json b = {{"method", "fast"}, {"mean_deg", 4.0}, {"threads", 2}};
  EXPECT_EQ(mean_row({&a, &b}), (Json{{"method", "fast"}, {"mean_deg", 2.5}, {"threads", 2}}));
}

TEST(AccuracyTable, RefusesScenesAndMethodsThatAreNotThere) {
  AccuracyTableOptions options;
  options.quick = true;
  options.scene = "deep denim";
  EXPECT_EQ(accuracy_table(options).error().where, "deep denim");
  options.scene = "deep satin";
  options.methods = {"fastest"};
  EXPECT_EQ(accuracy_table(options).error().where, "fastest");
}

}  // namespace
}  // namespace weft::bench
