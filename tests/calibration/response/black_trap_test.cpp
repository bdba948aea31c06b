// SPDX-License-Identifier: Apache-2.0
#include "calibration/response/black_trap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "simulator/camera/lens_veil.h"

namespace weft::calibration {
namespace {

using testing::HasSubstr;

constexpr Size kFrame = {240, 160};

// White paper lit from the left, with a black square, behind a lens that spreads `share` of all light.
Image<float> photograph(double share, double spread, int trap_px) {
  const auto sheet = [&](int x, int y) {
    const bool in_trap =
        std::abs(2 * x + 1 - kFrame.width) < trap_px && std::abs(2 * y + 1 - kFrame.height) < trap_px;
    return in_trap ? 0.0 : 0.6 * (1.2 - 0.4 * x / kFrame.width);
  };
  simulator::FrameLight light(kFrame);
  for (int row = 0; row < light.rows(); ++row) {
    for (int column = 0; column < light.columns(); ++column) {
      const Rect cell = light.cell(column, row);
      double sum = 0;
      for (int y = cell.y0; y < cell.y1; ++y) {
        for (int x = cell.x0; x < cell.x1; ++x) sum += sheet(x, y);
      }
      light.mean(column, row).fill(sum / static_cast<double>(cell.pixels()));
    }
  }
  const simulator::FrameLight veil = veil_of({.share = share, .spread = spread}, light);
  Image<float> picture(kFrame, 3);
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      for (int c = 0; c < 3; ++c)
        picture(x, y, c) = static_cast<float>(sheet(x, y) + veil.at(x, y)[static_cast<std::size_t>(c)]);
    }
  }
  return picture;
}

Result<TrapReading> read(std::initializer_list<double> shares, double spread, int trap_px = 40) {
  std::vector<Image<float>> pictures;
  for (const double share : shares) pictures.push_back(photograph(share, spread, trap_px));
  return read_black_trap(pictures);
}

TEST(BlackTrap, TellsTheShareWhateverItsSpread) {
  for (const double spread : {0.3, 0.5, 3.0}) {
    const auto trap = read({0.01}, spread);
    ASSERT_TRUE(trap) << trap.error().message();
    EXPECT_NEAR(trap->veil.share, 0.01, 0.0004) << "spread " << spread;
    for (const double share : trap->share_rgb) EXPECT_NEAR(share, trap->veil.share, 1e-6);
  }
}

TEST(BlackTrap, ScatterOfPhotographsIsItsSigma) {
  const auto trap = read({0.008, 0.012}, 0.5);
  ASSERT_TRUE(trap) << trap.error().message();
  EXPECT_NEAR(trap->veil.share, 0.01, 0.0002);
  EXPECT_NEAR(trap->veil.sigma_share, 0.002, 0.0001);
}

TEST(BlackTrap, ALensWithoutAVeilHasNone) {
  const auto trap = read({0}, 0.5);
  ASSERT_TRUE(trap) << trap.error().message();
  EXPECT_NEAR(trap->veil.share, 0, 1e-6);
}

TEST(BlackTrap, ASheetWithoutATrapOrWithASpeckIsRefused) {
  for (const int trap_px : {0, 6}) {
    const auto trap = read({0.01}, 0.5, trap_px);
    ASSERT_FALSE(trap) << trap_px;
    EXPECT_THAT(trap.error().message(), HasSubstr("no black trap was found"));
  }
  EXPECT_FALSE(read_black_trap({}));
}

}  // namespace
}  // namespace weft::calibration
