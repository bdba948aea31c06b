// SPDX-License-Identifier: Apache-2.0
#include "solver/uncertainty/model_sigma.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::solver {
namespace {

// Photosites of a preview's pixel lie a quarter of a pixel to both sides of its middle.
TEST(WithinPixel, IsAQuarterOfAStepOnAYarnOfEvenCurvature) {
  constexpr float kStep = 0.12F;  // radians from pixel to pixel
  const float predicted = std::sqrt(within_pixel2(kStep, kStep)), true_angle = kStep / 4;
  EXPECT_NEAR(predicted / true_angle, 1.1, 0.2);
}

TEST(WithinPixel, IsHalfTheFoldWhereAPixelIsMixedFromTwoYarns) {
  constexpr float kFold = 0.6F;  // radians between the two, whose normals meet
  const float predicted = std::sqrt(within_pixel2(-kFold / 2, -kFold / 2)), true_angle = kFold / 2;
  EXPECT_NEAR(predicted / true_angle, 0.9, 0.2);
}

TEST(WithinPixel, IsThatOfTheYarnBesideAPixelThatIsMixed) {
  constexpr float kStep = 0.12F, kFold = 0.6F;
  const float beside = std::sqrt(within_pixel2(kStep, kStep - kFold / 2));
  EXPECT_NEAR(beside / (kStep / 4), 1.3, 0.3);
  EXPECT_FLOAT_EQ(within_pixel2(kStep, kStep - kFold / 2), within_pixel2(kStep - kFold / 2, kStep));
}

}  // namespace
}  // namespace weft::solver
