// SPDX-License-Identifier: Apache-2.0
#include "solve/correction/light_correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

constexpr Size kReliefSize = {192, 160};
constexpr int kEdge = 39;  // the last column of the high side
constexpr float kShadow = -std::numeric_limits<float>::infinity();

// A step down across the frame, lit and solved as if it were flat.
class Step {
 public:
  Step(double height_px, const LightCorrectionOptions& options)
      : photographs_(developed(kReliefSize, {})),
        height_(kReliefSize),
        solved_{Image<float>(kReliefSize, 3), Image<float>(kReliefSize, 3)},
        readings_({64, 1}, 30) {
    for (int y = 0; y < kReliefSize.height; ++y) {
      std::fill_n(height_.plane().row(y), kEdge + 1, static_cast<float>(height_px));
      std::fill_n(solved_.normal.plane(2).row(y), kReliefSize.width, 1.0F);
      for (int c = 0; c < 3; ++c) std::fill_n(solved_.albedo.plane(c).row(y), kReliefSize.width, 0.5F);
    }
    relief_ = *solver::Relief::of(height_.plane(), 1);
    correction_.emplace(photographs_, solved_, relief_, options, 2);
    EXPECT_TRUE(correction_->prepare({0, 0, kReliefSize.width, kReliefSize.height}));
  }

  // The corrected reading of light k at a pixel, over the reading as it was.
  double share_left(std::size_t k, int x, int y) {
    const Rect tile = {x / 64 * 64, y, std::min(x / 64 * 64 + 64, kReliefSize.width), y + 1};
    TileReader reader(photographs_, {.width = 64, .height = 1});
    const auto as_read = reader.read(tile).readings;
    std::vector<View<float>> views;
    for (std::size_t i = 0; i < as_read.size(); ++i) {
      views.push_back(readings_.plane(static_cast<int>(i)));
      std::copy_n(as_read[i].row(0), tile.width(), views.back().row(0));
    }
    correction_->apply(tile, views);
    return views[3 * k + 1](x - tile.x0, 0) / as_read[3 * k + 1](x - tile.x0, 0);
  }

 private:
  Photographs photographs_;
  Image<float> height_;
  SolvedFrame solved_;
  Image<float> readings_;
  solver::Relief relief_;
  std::optional<LightCorrection> correction_;
};

TEST(LightCorrection, LeavesAFlatClothAsItIs) {
  Step flat(0, {.stages = {true, true}});
  for (std::size_t k = 0; k < 10; ++k) EXPECT_EQ(flat.share_left(k, 100, 80), 1) << "light " << k;
}

TEST(LightCorrection, MarksTheShadowOfAStepToItsEnd) {
  constexpr double kHeight_px = 8;
  Step step(kHeight_px, {.stages = {.shadows = true, .interreflection = false}});
  // Light 7 stands 28 degrees above the horizon, straight behind the step.
  const double end = kEdge + kHeight_px / std::tan(radians(28));
  EXPECT_EQ(step.share_left(7, static_cast<int>(end) - 2, 80), kShadow);
  EXPECT_EQ(step.share_left(7, static_cast<int>(end) + 2, 80), 1);
  EXPECT_EQ(step.share_left(7, kEdge - 10, 80), 1) << "the high side is in the light";
  for (const std::size_t k : {0U, 4U, 6U, 9U}) {
    EXPECT_EQ(step.share_left(k, static_cast<int>(end) - 2, 80), 1) << "light " << k;
  }
}

TEST(LightCorrection, SubtractsWhatALongWallSendsBack) {
  constexpr double kHeight_px = 16;
  Step wall(kHeight_px,
            {.stages = {.shadows = false, .interreflection = true}, .directions = 64, .reach_px = 64});
  for (const int x : {46, 50, 58}) {
    // A point sees an endless wall under half of 1 - cos of the angle to its upper edge.
    const double distance = x - kEdge - 0.5;
    const double seen = (1 - distance / std::hypot(distance, kHeight_px)) / 2;
    double left = 0;
    for (int y = 70; y < 90; ++y) left += wall.share_left(2, x, y) / 20;
    EXPECT_NEAR(1 - left, 0.5 * seen, 0.01) << "column " << x;
  }
}

}  // namespace
}  // namespace weft::solve
