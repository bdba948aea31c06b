// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/solve/solve_record.h"
#include "solver/deblur/sharpen.h"

namespace weft::solver {
namespace {

constexpr int kSide = 96;
constexpr double kPeriod_px = 8, kAlbedo = 0.5, kSteepest = 0.4;
constexpr double kSigma_px = 0.7;
constexpr double kRadian = 0.017453292519943295;

// Maps of a cloth of grey albedo whose slope along x is a wave, solved with errors of `sigma_deg` in a plane
// of two directions, behind a lens that leaves `left` of the wave.
struct Maps {
  Image<float> planes{{kSide, kSide}, 10}, out{{kSide, kSide}, 10};
  Image<std::uint16_t> status{{kSide, kSide}};

  Maps(double left, double sigma_deg) {
    std::mt19937 random(1);
    std::normal_distribution<double> error(0, sigma_deg * kRadian / std::sqrt(2.0));
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const double nx = left * slope(x) + error(random), ny = error(random),
                     nz = std::sqrt(1 - kSteepest * kSteepest);
        const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
        planes(x, y, 0) = static_cast<float>(nx / length);
        planes(x, y, 1) = static_cast<float>(ny / length);
        planes(x, y, 2) = static_cast<float>(nz / length);
        for (int c = 0; c < 3; ++c) {
          planes(x, y, 3 + c) = static_cast<float>(kAlbedo * length);
          planes(x, y, 6 + c) = 1e-4F;
        }
        planes(x, y, 9) = static_cast<float>(sigma_deg);
      }
    }
  }

  static double slope(int x) { return kSteepest * std::sin(2 * M_PI * x / kPeriod_px); }

  double sharpen() {
    const auto in = [&](int p) { return View<const float>(planes.plane(p)); };
    const RowsToSharpen rows = {
        {kSide, kSide},        0,     CfaPattern(),  {in(0), in(1), in(2)}, {in(3), in(4), in(5)},
        {in(6), in(7), in(8)}, in(9), status.plane()};
    const SharpenedRows to = {0,
                              {out.plane(0), out.plane(1), out.plane(2)},
                              {out.plane(3), out.plane(4), out.plane(5)},
                              {out.plane(6), out.plane(7), out.plane(8)},
                              out.plane(9)};
    std::array<DeblurFilter, 3> filters;
    filters.fill(deblur_filter(kSigma_px, 0.025));
    return solver::sharpen(rows, filters, {0, 0, kSide, kSide}, to) / (kSide * kSide);
  }

  // Rms over the middle of how far the direction is off across x, against the wave that was there, degrees.
  double error_deg(const Image<float>& maps) const {
    double sum = 0, n = 0;
    for (int y = 16; y < kSide - 16; ++y) {
      for (int x = 16; x < kSide - 16; ++x, ++n) {
        const double was = std::atan2(slope(x), std::sqrt(1 - kSteepest * kSteepest));
        const double is = std::atan2(static_cast<double>(maps(x, y, 0)), static_cast<double>(maps(x, y, 2)));
        sum += (is - was) * (is - was);
      }
    }
    return std::sqrt(sum / n) / kRadian;
  }
};

// What a Gaussian leaves of the wave.
double left_of_wave() {
  const double w = 2 * M_PI / kPeriod_px;
  return std::exp(-0.5 * kSigma_px * kSigma_px * w * w);
}

TEST(DeblurFilter, LeavesAConstantAndEverythingWhereThereIsNoBlur) {
  for (const double sigma_px : {0.0, 0.3, 0.5, 1.0}) {
    const DeblurFilter filter = deblur_filter(sigma_px, 0.02);
    double sum = static_cast<double>(filter.weights[0]);
    for (std::size_t k = 1; k < filter.weights.size(); ++k) sum += 2 * static_cast<double>(filter.weights[k]);
    EXPECT_NEAR(sum, 1, 1e-5) << sigma_px;
  }
  EXPECT_NEAR(static_cast<double>(deblur_filter(0, 0).weights[0]), 1, 1e-5);
}

TEST(DeblurFilter, BringsBackWhatTheBlurTookOfAWave) {
  const DeblurFilter filter = deblur_filter(kSigma_px, 1e-4);
  for (const double period_px : {6.0, 8.0, 12.0, 24.0}) {
    const double w = 2 * M_PI / period_px;
    double gain = static_cast<double>(filter.weights[0]);
    for (int k = 1; k <= kDeblurReach; ++k)
      gain += 2 * static_cast<double>(filter.weights[static_cast<std::size_t>(k)]) * std::cos(k * w);
    EXPECT_NEAR(gain * std::exp(-0.5 * kSigma_px * kSigma_px * w * w), 1, 0.08) << "period " << period_px;
  }
}

TEST(BestShare, IsWienersAndNothingInNoise) {
  EXPECT_FLOAT_EQ(best_share(1, 0), 1);
  EXPECT_FLOAT_EQ(best_share(8, 1), 0.75F);
  EXPECT_FLOAT_EQ(best_share(2, 1), 0);
  EXPECT_FLOAT_EQ(best_share(0, 0), 0);
}

TEST(Sharpen, BringsBackTheSlopesOfABlurredCloth) {
  Maps maps(left_of_wave(), 0.05);
  const double share = maps.sharpen(), before = maps.error_deg(maps.planes), after = maps.error_deg(maps.out);
  EXPECT_GT(share, 0.8);
  EXPECT_GT(before, 1.5);
  EXPECT_LT(after, before / 3) << before;
}

TEST(Sharpen, LeavesAFlatClothToItsNoise) {
  Maps maps(0, 1);
  const double share = maps.sharpen();
  EXPECT_LT(share, 0.05);
  double before = 0, after = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      before += std::pow(static_cast<double>(maps.planes(x, y, 0)), 2);
      after += std::pow(static_cast<double>(maps.out(x, y, 0)), 2);
    }
  }
  EXPECT_LT(std::sqrt(after / before), 1.1);
}

TEST(Sharpen, StaysAwayFromWhatHasNoSolution) {
  Maps maps(left_of_wave(), 0.05);
  maps.status(48, 48) = kNoSolution;
  maps.sharpen();
  EXPECT_EQ(maps.out(50, 48, 0), maps.planes(50, 48, 0));
  EXPECT_EQ(maps.out(48 + kDeblurReach, 48, 0), maps.planes(48 + kDeblurReach, 48, 0));
  EXPECT_NE(maps.out(48 + kDeblurReach + 2, 48, 0), maps.planes(48 + kDeblurReach + 2, 48, 0));
}

}  // namespace
}  // namespace weft::solver
