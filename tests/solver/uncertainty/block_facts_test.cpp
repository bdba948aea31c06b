// SPDX-License-Identifier: Apache-2.0
#include "solver/uncertainty/block_facts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/vec.h"
#include "core/image/image.h"
#include "core/solve/solve_record.h"

namespace weft::solver {
namespace {

constexpr int kSide = 64;

struct Slope {
  double p, q;
};

// A block with these slopes; y is up, rows go down.
struct DrawnBlock {
  Image<float> normal{{kSide, kSide}, 3}, residual{{kSide, kSide}}, albedo{{kSide, kSide}},
      noise{{kSide, kSide}}, model{{kSide, kSide}};
  Image<std::uint16_t> status{{kSide, kSide}};

  explicit DrawnBlock(const std::function<Slope(double x, double y)>& slope) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const auto [p, q] = slope(x, -y);
        const Vec3 n = normalized({-p, -q, 1});
        normal(x, y, 0) = static_cast<float>(n.x);
        normal(x, y, 1) = static_cast<float>(n.y);
        normal(x, y, 2) = static_cast<float>(n.z);
        albedo(x, y) = 0.5F;
      }
    }
  }
  BlockFacts facts(const ModelTraits& traits = {}) const {
    BlockSums sums;
    for (int y = 0; y + 1 < kSide; ++y) {
      sums.add({{normal.plane(0).row(y), normal.plane(1).row(y), normal.plane(2).row(y)},
                {normal.plane(0).row(y + 1), normal.plane(1).row(y + 1), normal.plane(2).row(y + 1)},
                residual.plane().row(y),
                albedo.plane().row(y),
                noise.plane().row(y),
                model.plane().row(y),
                status.plane().row(y)},
               kSide);
    }
    return sums.facts(traits, 0);
  }
};

// z = a x^2 / 2 + b x y has p = a x + b y and q = b x, and a curl of nothing; p = -c y, q = c x has one of -2
// c.
TEST(BlockFacts, TellASurfaceFromAWhirl) {
  const BlockFacts surface = DrawnBlock([](double x, double y) {
                               return Slope{0.006 * x + 0.004 * y, 0.004 * x};
                             }).facts();
  EXPECT_NEAR(std::exp(surface[kLogBend]), std::sqrt(0.006 * 0.006 + 2 * 0.004 * 0.004), 1e-5);
  EXPECT_LT(std::exp(surface[kLogCurl]), 1e-3);
  const BlockFacts whirl = DrawnBlock([](double x, double y) {
                             return Slope{-0.004 * y, 0.004 * x};
                           }).facts();
  EXPECT_NEAR(std::exp(whirl[kLogCurl]), std::sqrt(2.0), 1e-3) << "2 c over sqrt(2) c";
}

TEST(BlockFacts, AreRmsOfWhatFormulasSayAndMeansOfTheRest) {
  DrawnBlock block([](double, double) { return Slope{0.3, 0.4}; });
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      block.model(x, y) = y % 2 == 0 ? 1.0F : 7.0F;  // rms 5
      block.noise(x, y) = 0.2F;
      block.residual(x, y) = 0.01F;
      block.status(x, y) = y < kSide / 4 ? kSpecular : 0;
    }
  }
  const BlockFacts facts = block.facts({.turned_deg = 0.5});
  EXPECT_NEAR(std::exp(facts[kLogModel]), 5, 0.1);
  EXPECT_NEAR(std::exp(facts[kLogNoise]), 0.2, 1e-5);
  EXPECT_NEAR(std::exp(facts[kLogMisfit]), 0.01, 1e-6);
  EXPECT_NEAR(facts[kSlope], 0.5, 1e-6);
  EXPECT_NEAR(facts[kAlbedo], 0.5, 1e-6);
  EXPECT_NEAR(facts[kSpecularShare], 0.25, 0.01);
  EXPECT_NEAR(facts[kMisfitPeaks], 0, 1e-4) << "an even misfit has no peaks";
  EXPECT_NEAR(std::exp(facts[kLogTurned]), 0.5, 1e-6);
}

TEST(BlockFacts, SeeThatFurrowsArePaler) {
  DrawnBlock block([](double x, double) { return Slope{0.3 * std::sin(x / 3), 0}; });
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double slope = 0.3 * std::sin(x / 3.0);
      block.albedo(x, y) = static_cast<float>(0.5 - slope * slope);
    }
  }
  EXPECT_NEAR(block.facts()[kAlbedoFollowsSlope], -1, 1e-4);
}

TEST(BlockFacts, AreNumbersWhereNothingIsSolved) {
  DrawnBlock block([](double, double) { return Slope{0, 0}; });
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) block.status(x, y) = kNoSolution;
  }
  for (const float fact : block.facts()) EXPECT_TRUE(std::isfinite(fact)) << fact;
}

}  // namespace
}  // namespace weft::solver
