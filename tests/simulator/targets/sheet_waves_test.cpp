// SPDX-License-Identifier: Apache-2.0
#include "simulator/targets/target.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/vec.h"

namespace weft::simulator {
namespace {

struct Spread {
  double brightness = 0;  ///< rms about 1
  double slope = 0;       ///< rms
};

/// Over a square of `count` x `count` spots, `step_mm` apart, with boxes of `box_mm`.
Spread spread(const PaperSheet& sheet, int count, double step_mm, double box_mm) {
  Spread sum;
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      const SheetPoint point = sheet.at({(i + 0.5) * step_mm, (j + 0.5) * step_mm, box_mm, box_mm});
      sum.brightness += (point.brightness - 1) * (point.brightness - 1);
      sum.slope += point.slope_u * point.slope_u + point.slope_v * point.slope_v;
    }
  }
  return {std::sqrt(sum.brightness) / count, std::sqrt(sum.slope) / count};
}

TEST(Sheet, IsAPlaneOfEvenAlbedoUnlessToldOtherwise) {
  const SheetPoint point = PaperSheet({}, 1, 0).at({12, -7, 0.1, 0.1});
  EXPECT_EQ(point.height_mm, 0);
  EXPECT_EQ(point.slope_u, 0);
  EXPECT_EQ(point.slope_v, 0);
  EXPECT_EQ(point.brightness, 1);
}

TEST(Sheet, HasWavesOfTheSlopeAskedFor) {
  SheetSettings settings;
  settings.waviness_deg = 0.5;
  settings.wavelength_mm = 20;
  // 12 sines beat against each other: over 100 wavelengths the mean square is good to a few percent.
  EXPECT_NEAR(degrees(std::atan(spread(PaperSheet(settings, 3, 0), 200, 10.3, 0).slope)), 0.5, 0.02);
}

TEST(Sheet, HasWavesWhoseSlopeIsThatOfTheirHeight) {
  SheetSettings settings;
  settings.waviness_deg = 2;
  const PaperSheet sheet(settings, 5, 0);
  const double h = 1e-3;
  for (const double u : {-80.0, 3.0, 41.0}) {
    const double by_height = (sheet.at({u + h, 9}).height_mm - sheet.at({u - h, 9}).height_mm) / (2 * h);
    EXPECT_NEAR(sheet.at({u, 9}).slope_u, by_height, 1e-8);
    const double across = (sheet.at({9, u + h}).height_mm - sheet.at({9, u - h}).height_mm) / (2 * h);
    EXPECT_NEAR(sheet.at({9, u}).slope_v, across, 1e-8);
  }
}

TEST(Sheet, HasGrainOfTheStrengthAskedFor) {
  SheetSettings settings;
  settings.grain_percent = 2;
  settings.grain_deg = 3;
  settings.grain_mm = 0.1;
  const PaperSheet sheet(settings, 7, 0);
  const Spread points = spread(sheet, 200, 0.1, 0);
  EXPECT_NEAR(points.brightness, 0.02, 0.0004);  // 40000 grains: 1 percent is three standard deviations
  EXPECT_NEAR(degrees(std::atan(points.slope)), 3, 0.06);
}

TEST(Sheet, ShowsLessGrainInALargerPixelWhateverTheLatticeItIsDrawnFrom) {
  SheetSettings settings;
  settings.grain_percent = 10;
  settings.grain_mm = 0.1;
  const PaperSheet sheet(settings, 7, 0);
  // A box of n x n whole grains has 1/n of their rms; 8 grains across are drawn as 4 of twice the size.
  for (const int n : {1, 2, 4, 8, 32}) {
    const double box_mm = 0.1 * n * (1 - 1e-9);
    EXPECT_NEAR(spread(sheet, 100, 0.1 * n, box_mm).brightness * n, 0.1, 0.003) << n << " grains";
  }
}

TEST(Sheet, MeanOverGrainsIsByArea) {
  SheetSettings settings;
  settings.grain_percent = 10;
  settings.grain_mm = 1;
  const PaperSheet sheet(settings, 7, 0);
  const double left = sheet.at({0.5, 0.5}).brightness;
  const double right = sheet.at({1.5, 0.5}).brightness;
  EXPECT_NE(left, right);
  EXPECT_NEAR(sheet.at({0.9, 0.5, 0.8, 0.2}).brightness, (0.5 * left + 0.3 * right) / 0.8, 1e-12);
}

TEST(Sheet, DiffersBySeedAndNumberAndNotOtherwise) {
  SheetSettings settings;
  settings.grain_percent = 5;
  settings.waviness_deg = 1;
  const TargetSpot spot = {3.21, -4.56, 0.05, 0.05};
  const SheetPoint one = PaperSheet(settings, 1, 0).at(spot);
  EXPECT_EQ(one.brightness, PaperSheet(settings, 1, 0).at(spot).brightness);
  EXPECT_NE(one.brightness, PaperSheet(settings, 2, 0).at(spot).brightness);
  EXPECT_NE(one.brightness, PaperSheet(settings, 1, 1).at(spot).brightness);
  EXPECT_NE(one.height_mm, PaperSheet(settings, 1, 1).at(spot).height_mm);
}

TEST(Sheet, StaysFiniteAndQuickForAnySpot) {
  SheetSettings settings;
  settings.grain_percent = 20;
  settings.grain_mm = 0.01;
  const PaperSheet sheet(settings, 1, 0);
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const TargetSpot& spot : {TargetSpot{1e4, -1e4, 1e4, 1}, TargetSpot{1e300, -inf, 1, 1e300},
                                 TargetSpot{0, 0, inf, inf}, TargetSpot{nan, nan, nan, nan}}) {
    EXPECT_NEAR(sheet.at(spot).brightness, 1, 0.35) << spot.u_mm << ", box of " << spot.width_mm;
  }
}

TEST(Sheet, ReflectsLessAtSlantingLightThanLambert) {
  EXPECT_EQ(lambert_factor(0, 0.3), 1);
  EXPECT_EQ(lambert_factor(0.05, 1), 1);
  EXPECT_NEAR(lambert_factor(0.05, 0.5), 0.975, 1e-15);
}

TEST(Sheet, NamesTheSettingThatIsOutOfItsRange) {
  SheetSettings settings;
  settings.grain_mm = 0;
  EXPECT_EQ(check_sheet(settings).error().where, "grain_mm");
  settings = {};
  settings.waviness_deg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check_sheet(settings).error().where, "waviness_deg");
  EXPECT_TRUE(check_sheet({}));
}

}  // namespace
}  // namespace weft::simulator
