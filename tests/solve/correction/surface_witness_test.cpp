// SPDX-License-Identifier: Apache-2.0
#include "solve/correction/surface_witness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/solve/cloth.h"

namespace weft::solve {
namespace {

constexpr Size kWitnessed = {256, 192};

// What standard solves, with slopes that are `steeper` times as steep and whirl around the frame's corner.
class Turning : public solver::Method {
 public:
  Turning(double steeper, double whirl) : steeper_(steeper), whirl_(whirl) {}
  void solve(const solver::TileInput& input, const solver::TileOutput& output) const override {
    standard_->solve(input, output);
    for (int y = 0; y < input.tile.height(); ++y) {
      for (int x = 0; x < input.tile.width(); ++x) {
        const auto part = [&](std::size_t c) { return static_cast<double>(output.normal[c](x, y)); };
        const double p = -part(0) / part(2), q = -part(1) / part(2);
        const Vec3 turned = normalized({-(steeper_ * p + whirl_ * (input.tile.y0 + y)),
                                        -(steeper_ * q + whirl_ * (input.tile.x0 + x)), 1});
        output.normal[0](x, y) = static_cast<float>(turned.x);
        output.normal[1](x, y) = static_cast<float>(turned.y);
        output.normal[2](x, y) = static_cast<float>(turned.z);
      }
    }
  }

 private:
  double steeper_, whirl_;
  std::unique_ptr<solver::Method> standard_ = solver::standard_method();
};

CurlWitness asked(double steeper, double whirl) {
  const Photographs photographs = developed(kWitnessed, {.normal = wave});
  const solver::BlockChoice everywhere(solver::blocks_of(kWitnessed), {1.0F});
  // The base whirls a little, so that there is a curl to rise.
  return ask_curl(photographs, Turning(1, 1e-4), Turning(steeper, whirl), everywhere, 2);
}

TEST(SurfaceWitness, MeasuresTheCurlThatIsThere) {
  const CurlWitness witness = asked(1, 3e-4);
  EXPECT_NEAR(witness.base, 2e-4, 1e-6);
  EXPECT_NEAR(witness.better, 6e-4, 1e-6);
}

TEST(SurfaceWitness, ObjectsWhereCurlRises) {
  EXPECT_TRUE(asked(1, 1.1e-4).objects());
  EXPECT_FALSE(asked(1, 1.0e-4).objects());
  EXPECT_FALSE(asked(1, 0.5e-4).objects());
}

TEST(SurfaceWitness, LetsAllSlopesBeALittleSteeper) {
  EXPECT_FALSE(asked(1.07, 1.07e-4).objects());
  EXPECT_TRUE(asked(1.3, 1.3e-4).objects()) << "no lobe makes all slopes so much steeper";
}

TEST(SurfaceWitness, HasNothingToSayWhereTheBetterWaySolvesNothing) {
  const Photographs photographs = developed(kWitnessed, {.normal = wave});
  const solver::BlockChoice nowhere(solver::blocks_of(kWitnessed), {0.0F});
  EXPECT_FALSE(ask_curl(photographs, Turning(1, 0), Turning(1, 1e-2), nowhere, 1).objects());
}

}  // namespace
}  // namespace weft::solve
