// SPDX-License-Identifier: Apache-2.0
#include "material/layers/fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/vec.h"
#include "material/layers/lay.h"

namespace weft::material {
namespace {

// A tile of one wave each way: of 8 mm, its height and its slopes.
constexpr double kSide_mm = 8;

struct Tile {
  ParameterField height, slopes;
};

Tile wave_tile(Size size, double side_mm = kSide_mm) {
  Image<float> height(size), slopes(size, 2);
  const double w = 2 * kPi / side_mm;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double u = (x + 0.5) * side_mm / size.width, v = -(y + 0.5) * side_mm / size.height;
      height(x, y) = static_cast<float>(0.3 * std::sin(w * u) + 0.2 * std::cos(w * v));
      slopes(x, y, 0) = static_cast<float>(0.3 * w * std::cos(w * u));
      slopes(x, y, 1) = static_cast<float>(-0.2 * w * std::sin(w * v));
    }
  }
  return {ParameterField::of(std::move(height)), ParameterField::of(std::move(slopes))};
}

Result<LayerFit> fit_of(double layer_mm, double below_mm, Size below, double repeat_mm = 0,
                        bool is_tile = true) {
  return fit_layer({.layer_mm = {layer_mm, layer_mm},
                    .below_mm = {below_mm, below_mm},
                    .repeat_mm = {repeat_mm, repeat_mm},
                    .below = below},
                   is_tile);
}

TEST(Fit, OfALayerOfTheSameGridIsBitForBit) {
  const Tile tile = wave_tile({48, 32});
  const Result<LayerFit> fit = fit_layer({.layer_mm = {8, 8}, .below_mm = {8, 8}, .below = {48, 32}}, true);
  ASSERT_TRUE(fit);
  const ParameterField same = fitted(tile.slopes, BlendSpace::kSlope, *fit, {48, 32}, 2);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 48; ++x) ASSERT_EQ(same.map(x, y, 1), tile.slopes.map(x, y, 1)) << x << " " << y;
  }
}

TEST(Fit, RepeatsAWholeNumberOfTimesAtTrueSize) {
  const Tile tile = wave_tile({64, 64});
  const Result<LayerFit> fit = fit_of(8, 24, {384, 384});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->across, 3);
  const ParameterField fine = fitted(tile.height, BlendSpace::kLinear, *fit, {384, 384}, 0);
  double worst = 0;
  for (int x = 0; x < 384; ++x) {
    const double u = (x + 0.5) * 24 / 384, v = -0.5 * 24 / 384, w = 2 * kPi / kSide_mm;
    worst = std::max(worst, std::abs(fine.at(x, 0) - (0.3 * std::sin(w * u) + 0.2 * std::cos(w * v))));
    EXPECT_NEAR(fine.at(x, 7), fine.at((x + 128) % 384, 7), 1e-6);
  }
  // A straight line between samples of a wave of 64 is off by (2 pi / 64)^2 / 8 of its height.
  EXPECT_LT(worst, 0.5 * std::pow(2 * kPi / 64, 2) / 8 * 1.05);
}

TEST(Fit, OfFewerPixelsKeepsTheMean) {
  const Tile tile = wave_tile({96, 96});
  const Result<LayerFit> fit = fit_of(8, 8, {32, 32});
  ASSERT_TRUE(fit);
  const ParameterField coarse = fitted(tile.height, BlendSpace::kLinear, *fit, {32, 32}, 0);
  EXPECT_NEAR(means_of(coarse)[0], means_of(tile.height)[0], 1e-6);
}

TEST(Fit, StretchedSlopesAreThoseOfTheStretchedHeight) {
  const Tile tile = wave_tile({512, 512});
  const Result<LayerFit> fit = fit_of(8, 24, {768, 768}, 12);
  ASSERT_TRUE(fit) << fit.error().message();
  EXPECT_DOUBLE_EQ(fit->stretch_x, 1.5);
  const ParameterField height = fitted(tile.height, BlendSpace::kLinear, *fit, {768, 768}, 0);
  const ParameterField slopes = fitted(tile.slopes, BlendSpace::kSlope, *fit, {768, 768}, 0);
  const double mm = 24.0 / 768;
  for (int x = 10; x < 200; x += 7) {
    EXPECT_NEAR((height.at(x + 1, 40) - height.at(x - 1, 40)) / (2 * mm), slopes.at(x, 40, 0), 2e-3);
    EXPECT_NEAR((height.at(x, 39) - height.at(x, 41)) / (2 * mm), slopes.at(x, 40, 1), 2e-3);
  }
}

TEST(Fit, ATurnedLayerHasTheSlopesOfItsTurnedHeight) {
  const Tile tile = wave_tile({96, 96});
  Result<LayerFit> fit = fit_of(8, 8, {96, 96});
  ASSERT_TRUE(fit);
  for (const int turns : {1, 2, 3}) {
    fit->quarter_turns = turns;
    const ParameterField height = fitted(tile.height, BlendSpace::kLinear, *fit, {96, 96}, 0);
    const ParameterField slopes = fitted(tile.slopes, BlendSpace::kSlope, *fit, {96, 96}, 0);
    const double mm = kSide_mm / 96;
    for (int x = 5; x < 90; x += 11) {
      EXPECT_NEAR((height.at(x + 1, 20) - height.at(x - 1, 20)) / (2 * mm), slopes.at(x, 20, 0), 2e-3)
          << turns;
      EXPECT_NEAR((height.at(x, 19) - height.at(x, 21)) / (2 * mm), slopes.at(x, 20, 1), 2e-3) << turns;
    }
  }
  // What was right is up after a quarter turn counter-clockwise: an axis along x lies along y.
  const auto along_x = axis_of(0.4, 0);
  fit->quarter_turns = 1;
  const ParameterField axis =
      fitted(ParameterField::same({along_x[0], along_x[1], 0}, 2), BlendSpace::kAxis, *fit, {96, 96}, 0);
  EXPECT_NEAR(axis_from(axis.constant[0], axis.constant[1]).azimuth_deg, 90, 1e-9);
}

TEST(Fit, RefusesWhatDoesNotRepeatAWholeNumberOfTimes) {
  const Result<LayerFit> fit = fit_of(7, 24, {64, 64});
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message().find("7 x 7 mm, which does not fit 24 x 24 mm"), std::string::npos)
      << fit.error().message();
  EXPECT_NE(fit.error().message().find("tile_mm"), std::string::npos);
  EXPECT_TRUE(fit_of(7, 24, {64, 64}, 8));
  EXPECT_FALSE(fit_of(7, 24, {64, 64}, 7)) << "a tile would not go on at its border";
  EXPECT_TRUE(fit_of(7, 24, {64, 64}, 7, false));
  EXPECT_FALSE(fit_of(0, 24, {64, 64}));
  const Result<LayerFit> near = fit_of(8.03, 24, {64, 64});
  ASSERT_TRUE(near);
  EXPECT_EQ(near->across, 3);
}

TEST(Fit, IsTheSameForAnyThreads) {
  const Tile tile = wave_tile({61, 47});
  const Result<LayerFit> fit = fit_of(8, 16, {200, 200});
  ASSERT_TRUE(fit);
  const ParameterField one = fitted(tile.slopes, BlendSpace::kSlope, *fit, {200, 200}, 1);
  const ParameterField four = fitted(tile.slopes, BlendSpace::kSlope, *fit, {200, 200}, 4);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) ASSERT_EQ(one.map(x, y, 0), four.map(x, y, 0));
  }
}

}  // namespace
}  // namespace weft::material
