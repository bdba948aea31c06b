// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/paper_evenness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace weft::calibration {
namespace {

constexpr Size kSize = {600, 400};
constexpr double kMmPerPixel = 0.4;

/// A sheet that lies flat and fills most of the frame, under light that falls off to one side; `factor` in a
/// patch of 40 pixels at (300, 200).
RawFrame paper(double factor) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>(kSize);
  frame.black = {{{100, 100}, {100, 100}}};
  frame.white = 16000;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const double u = x / 300.0 - 1, v = y / 200.0 - 1;
      const double light = 6000 * std::exp(0.5 * u - 0.3 * v * v + 0.1 * u * v);
      const bool is_patch = std::abs(x - 300) < 20 && std::abs(y - 200) < 20;
      frame.counts(x, y) = static_cast<std::uint16_t>(std::lround(100 + light * (is_patch ? factor : 1)));
    }
  }
  return frame;
}

Sheet sheet_of(double width_mm, double height_mm) {
  Sheet sheet;
  sheet.width_mm = width_mm;
  sheet.height_mm = height_mm;
  return sheet;
}

std::optional<PaperUnevenness> unevenness_of(double factor) {
  return find_unevenness(paper(factor), overhead_camera(kSize, 600, kMmPerPixel), sheet_of(230, 150), Pose());
}

TEST(PaperEvenness, SeesNothingInLightThatFallsOffSlowly) {
  EXPECT_FALSE(unevenness_of(1));
  EXPECT_FALSE(unevenness_of(1.02)) << "less than three percent is paper";
}

TEST(PaperEvenness, FindsAFoldWhereItIsAndByHowMuch) {
  for (const double factor : {1.08, 0.92}) {
    const auto found = unevenness_of(factor);
    ASSERT_TRUE(found) << factor;
    EXPECT_NEAR(found->departure, factor - 1, 0.01);
    EXPECT_GE(found->squares, 9);
    EXPECT_LT(std::hypot(found->at.x - 300, found->at.y - 200), 25);
  }
}

TEST(PaperEvenness, SaysNothingOfASheetThatIsNotInSight) {
  EXPECT_FALSE(
      find_unevenness(paper(1.5), overhead_camera(kSize, 600, kMmPerPixel), sheet_of(20, 20), Pose()));
}

}  // namespace
}  // namespace weft::calibration
