// SPDX-License-Identifier: Apache-2.0
#include "simulator/transport/diffusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace weft::simulator {
namespace {

/// What leaves a square of that side around a pixel that one unit of light enters.
std::vector<double> left_of_a_point(const Diffusion& diffusion, int half) {
  const int in_half = half + diffusion.radius(), in_side = 2 * in_half + 1, side = 2 * half + 1;
  std::vector<double> entered(static_cast<std::size_t>(in_side * in_side));
  entered[entered.size() / 2] = 1;
  std::vector<double> left(static_cast<std::size_t>(side * side));
  diffusion.add(entered, {-half, -half, half + 1, half + 1}, left);
  return left;
}

TEST(Diffusion, LosesNoLightAndCarriesItItsMeanDistance) {
  for (const double mean_px : {4.0, 9.0}) {
    const Diffusion diffusion(mean_px);
    const int half = diffusion.radius();
    const std::vector<double> left = left_of_a_point(diffusion, half);
    double sum = 0, mean = 0;
    std::size_t i = 0;
    for (int y = -half; y <= half; ++y) {
      for (int x = -half; x <= half; ++x, ++i) {
        sum += left[i];
        mean += left[i] * std::hypot(x, y);
      }
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(mean / mean_px, 1, 0.01) << mean_px << " pixels";
  }
}

// K0(r / l) / (2 pi l^2), integrated over the half plane beyond a straight edge, is exp(-d / l) / 2.
TEST(Diffusion, FadesBehindAnEdgeAsLightInASheetDoes) {
  constexpr double kMean_px = 12;
  const double l_px = kMean_px * 2 / 3.14159265358979323846;
  const Diffusion diffusion(kMean_px);
  const int radius = diffusion.radius(), width = 41, in_width = width + 2 * radius,
            in_height = 1 + 2 * radius;
  std::vector<double> lit(static_cast<std::size_t>(in_width * in_height));
  for (int y = 0; y < in_height; ++y) {
    for (int x = 0; x < radius; ++x) lit[static_cast<std::size_t>(y * in_width + x)] = 1;  // left of column 0
  }
  std::vector<double> left(static_cast<std::size_t>(width));
  diffusion.add(lit, {0, 0, width, 1}, left);
  for (const int x : {2, 6, 12, 20}) {
    EXPECT_NEAR(left[static_cast<std::size_t>(x)], std::exp(-(x + 0.5) / l_px) / 2, 0.03) << x;
  }
}

TEST(Diffusion, GivesTheSameNumbersForEveryTile) {
  const Diffusion diffusion(3);
  const int radius = diffusion.radius(), side = 23, in_side = side + 2 * radius;
  std::vector<double> entered;
  for (int i = 0; i < in_side * in_side; ++i) entered.push_back(std::sin(0.1 * i * i));
  std::vector<double> whole(static_cast<std::size_t>(side * side)), column(static_cast<std::size_t>(side));
  diffusion.add(entered, {0, 0, side, side}, whole);
  std::vector<double> around;
  for (int y = 0; y < in_side; ++y)
    for (int x = 7; x <= 7 + 2 * radius; ++x)
      around.push_back(entered[static_cast<std::size_t>(y * in_side + x)]);
  diffusion.add(around, {7, 0, 8, side}, column);
  for (int y = 0; y < side; ++y)
    ASSERT_EQ(column[static_cast<std::size_t>(y)], whole[static_cast<std::size_t>(y * side + 7)]) << y;
}

TEST(Diffusion, OverNoDistanceLeavesLightWhereItIs) {
  EXPECT_EQ(left_of_a_point(Diffusion(0), 0), std::vector<double>{1});
}

}  // namespace
}  // namespace weft::simulator
