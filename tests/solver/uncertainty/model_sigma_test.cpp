// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/model_angles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/vec.h"
#include "core/image/image.h"
#include "core/rig/light_field.h"
#include "core/solve/solve_record.h"

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

// Ten lights at an angle from upright, and the same copied.
LightField ring_of(int copies) {
  DistantLights lights;
  for (int i = 0; i < 10 * copies; ++i) {
    const double turn = 2 * kPi * (i % 10) / 10, tilt = radians(i % 2 == 0 ? 35 : 60);
    lights.lights.push_back(
        {{std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)}, {1, 1, 1}});
  }
  return *LightField::make(lights, std::nullopt, {8, 8}, 0);
}

TEST(DegreesAResidual, AreNoFewerWhereLightsAreOnlyCopied) {
  const double ten = degrees_a_residual(ring_of(1), 0, 0), hundred = degrees_a_residual(ring_of(10), 0, 0);
  // N / (N - 3) aside, of 100 lights as many are independent as of 12.
  EXPECT_NEAR(hundred / ten, std::sqrt(10.0 / 12 * (100.0 / 97) / (10.0 / 7)), 1e-6);
}

// A row of black cloth that leans by 30 degrees, so that nothing but misfits counts.
struct LeaningRow {
  static constexpr int kWidth = 37;
  Image<float> normal{{kWidth, 1}, 3}, residual{{kWidth, 1}}, cells{{kWidth, 1}, 2}, angles{{kWidth, 1}};
  Image<std::uint16_t> status{{kWidth, 1}};
  ModelSurroundings around = {.slope2 = 1.0F / 3, .degrees_a_residual = 50};

  LeaningRow() {
    for (int x = 0; x < kWidth; ++x) normal(x, 0, 0) = 0.5F, normal(x, 0, 2) = std::sqrt(0.75F);
  }
  void solve() {
    Image<float> black({kWidth, 1});
    const SolvedPixels pixels = {{normal.plane(0).row(0), normal.plane(1).row(0), normal.plane(2).row(0)},
                                 residual.plane().row(0),
                                 black.plane().row(0),
                                 status.plane().row(0),
                                 {}};
    model_angles(pixels, {cells.plane(0).row(0), cells.plane(1).row(0)}, nullptr, around, {}, true, kWidth,
                 angles.plane().row(0));
  }
};

TEST(ModelAngles, AreThoseOfThePixelThatMisfitsInAnyLane) {
  LeaningRow row;
  for (int x = 0; x < LeaningRow::kWidth; ++x) row.residual(x, 0) = 0.01F * static_cast<float>(x);
  row.solve();
  const float first = row.angles(1, 0);
  EXPECT_GT(first, 0.1F);
  EXPECT_EQ(row.angles(0, 0), 0);
  for (int x = 2; x < LeaningRow::kWidth; ++x) {
    EXPECT_NEAR(row.angles(x, 0) / first, x, 1e-3 * x);
  }
}

TEST(ModelAngles, CountMisfitsLessWhereTheRobustLevelSolved) {
  LeaningRow row;
  std::fill_n(row.residual.plane().row(0), LeaningRow::kWidth, 0.05F);
  row.solve();
  const float usual = row.angles(3, 0);
  row.around.robust = 1;
  row.solve();
  EXPECT_LT(row.angles(3, 0), 0.5F * usual);
}

TEST(ModelAngles, AreZeroWithoutASolutionAndLargerInShadow) {
  LeaningRow row;
  row.status(4, 0) = kNoSolution;
  row.status(5, 0) = kShadowed;
  row.residual(4, 0) = 0.05F;
  row.solve();
  EXPECT_EQ(row.angles(4, 0), 0);
  EXPECT_GT(row.angles(5, 0), 0.1F);
  EXPECT_EQ(row.angles(6, 0), 0);
}

// The pixels that speak for cells of two rows of seven: even cells by the first row, odd ones by the second.
TEST(CellFacts, AreThoseOfEverySecondPixelByTurns) {
  constexpr int kCells = 7;
  Image<float> normal({2 * kCells, 2}, 3), residual({2 * kCells, 2}), albedo({2 * kCells, 2}),
      facts({kCells, 1}, kCellFacts);
  Image<std::uint16_t> status({2 * kCells, 2});
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 2 * kCells; ++x) {
      normal(x, y, 2) = 1;
      albedo(x, y) = static_cast<float>(100 * y + x + 1);
    }
  }
  status(5, 0) = kNoSolution;
  const auto row = [&](int y) -> SolvedPixels {
    return {{normal.plane(0).row(y), normal.plane(1).row(y), normal.plane(2).row(y)},
            residual.plane().row(y),
            albedo.plane().row(y),
            status.plane().row(y),
            {}};
  };
  std::array<float*, kCellFacts> to;
  for (std::size_t f = 0; f < to.size(); ++f) to[f] = facts.plane(static_cast<int>(f)).row(0);
  see_cells({row(0), row(1)}, true, false, kCells, to);
  const float expected[kCells] = {2, 104, 0, 108, 10, 112, 14};
  for (int x = 0; x < kCells; ++x) {
    EXPECT_EQ(facts(x, 0, kCellAlbedo), expected[x]) << x;
    EXPECT_EQ(facts(x, 0, kCellPixels), expected[x] > 0 ? 1 : 0) << x;
  }
}

}  // namespace
}  // namespace weft::solver
