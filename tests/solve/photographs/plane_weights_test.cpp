// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/plane_weights.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "solve/photographs/tile_reader.h"
#include "solver/method.h"
#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

constexpr Size kNoisySize = {256, 192};
constexpr std::array<double, 3> kNoisyAlbedo = {0.5, 0.3, 0.7};
constexpr std::array<double, 3> kSigma = {0.001, 0.002, 0.004};  // of a reading over its strength

// A level cloth under lamps that are not white, with noise of its own in each channel.
Photographs noisy() {
  const std::array<double, 3> rgb = {0.8, 1, 0.4};
  Photographs photographs = developed(kNoisySize, {.albedo = kNoisyAlbedo}, ten_lights(rgb));
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (Image<float>& image : std::get<Developed>(photographs.frames).rgb) {
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      for (int y = 0; y < kNoisySize.height; ++y) {
        for (int x = 0; x < kNoisySize.width; ++x)
          image(x, y, c) += static_cast<float>(rgb[i] * kSigma[i] * normal(random));
      }
    }
  }
  return photographs;
}

// Mean square of the angle to the vertical.
double mean_square(const Photographs& photographs, const solver::Method& method) {
  const Rect tile = {0, 0, kNoisySize.width, kNoisySize.height};
  TileReader reader(photographs, {.width = tile.width(), .height = tile.height()});
  Image<float> maps(kNoisySize, 11);
  Image<std::uint16_t> status(kNoisySize);
  solver::TileOutput output;
  for (int c = 0; c < 3; ++c) {
    const auto i = static_cast<std::size_t>(c);
    output.normal[i] = maps.plane(c);
    output.albedo[i] = maps.plane(3 + c);
    output.sigma_albedo[i] = maps.plane(6 + c);
  }
  output.sigma_normal_deg = maps.plane(9);
  output.residual = maps.plane(10);
  output.status = status.plane();
  method.solve(reader.read(tile), output);
  double sum = 0;
  for (int y = 0; y < kNoisySize.height; ++y) {
    for (int x = 0; x < kNoisySize.width; ++x)
      sum += std::pow(std::hypot(output.normal[0](x, y), output.normal[1](x, y)), 2);
  }
  return sum / static_cast<double>(kNoisySize.pixels());
}

// The bound of least squares over all thirty readings, each over its variance: the trace of the inverse of
// sum a_c^2 / v_c times sum_k l l^T, across the normal. Rings of lights have no products of x and y.
double bound() {
  double information = 0, xx = 0;
  for (std::size_t c = 0; c < 3; ++c) information += std::pow(kNoisyAlbedo[c] / kSigma[c], 2);
  for (const DistantLight& light : ten_lights().lights) xx += light.direction.x * light.direction.x;
  return 2 / (information * xx);
}

TEST(PlaneWeights, ReachTheBoundOfThreeChannelsOfNoiseOneTwoFour) {
  Photographs photographs = noisy();
  const auto fast = solver::fast_method(), exact = solver::exact_standard_method();
  const double by_luminance = std::sqrt(mean_square(photographs, *fast) / bound());
  photographs.plane_weights = measure_plane_weights(photographs);
  EXPECT_GT(by_luminance, 2) << "what luminance takes";
  EXPECT_NEAR(std::sqrt(mean_square(photographs, *fast) / bound()), 1, 0.03) << "in vectors";
  EXPECT_NEAR(std::sqrt(mean_square(photographs, *exact) / bound()), 1, 0.03) << "in double";
}

TEST(PlaneWeights, AreAlbedosOverVariances) {
  const std::array<double, 3> weights = measure_plane_weights(noisy());
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) sum += kNoisyAlbedo[c] / (kSigma[c] * kSigma[c]);
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(weights[c] * sum * kSigma[c] * kSigma[c] / kNoisyAlbedo[c], 1, 0.1) << c;
}

TEST(PlaneWeights, GiveNothingToAChannelWithoutLight) {
  const std::array<double, 3> weights =
      measure_plane_weights(developed({128, 64}, {.albedo = {0.4, 0.4, 0}}));
  EXPECT_NEAR(weights[0] + weights[1], 1, 1e-12);
  EXPECT_EQ(weights[2], 0);
}

TEST(PlaneWeights, OfMosaicsAndOfTooFewPixelsAreLuminance) {
  EXPECT_EQ(measure_plane_weights(mosaics({128, 64}, {})), solver::kLuminance);
  EXPECT_EQ(measure_plane_weights(developed({16, 16}, {})), solver::kLuminance);
}

}  // namespace
}  // namespace weft::solve
