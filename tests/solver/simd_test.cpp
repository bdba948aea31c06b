// SPDX-License-Identifier: Apache-2.0
// How far apart the SIMD targets of one machine may be. Threads and tiles change no byte; another vector
// length has other approximations of 1 / x and 1 / sqrt(x) to refine, and may fuse what this one rounds
// twice.
#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <cmath>
#include <limits>

#include "bench/oracles/hard_lights.h"
#include "bench/oracles/oracle_rig.h"

namespace weft {
namespace {

using test::Random;
using test::Trial;
using test::Truth;

// The bound that docs/numerics.md states: twice the condition number squared times the rounding of float32,
// in radians of the normal and relative to the albedo; each target may be off by half of it. The readings
// that plain least squares uses here have condition numbers up to 3; methods that reject may leave any three
// lights of the rig, up to 16.5.
constexpr double bound_of(double condition) {
  return 2 * condition * condition * 0x1p-24;
}
constexpr double kPlainBound = bound_of(3), kRejectingBound = bound_of(16.5);
// Sigma without a noise model comes from residuals, differences of larger numbers: of four readings they may
// be as small as 1e-4 of the albedo, and float32 keeps such a difference to 2^-24 / 1e-4. Where readings are
// doubted, what one round rounds goes into the weights of the next.
constexpr double kSigmaRelativeBound = 5e-4, kDoubtedSigmaRelativeBound = 1e-3;
// A reading exactly on a threshold falls to one side or the other.
constexpr double kShareOnAThreshold = 1e-3;

const Size kSimdSize = {320, 200};
const Rect kSimdTile = {64, 33, 64 + 131, 33 + 6};

void expect_within_bound(const Trial& here, const Trial& there, int planes, double bound) {
  int otherwise = 0;
  double normal_deg = 0, albedo = 0, sigma = 0;
  for (int y = 0; y < kSimdTile.height(); ++y) {
    for (int x = 0; x < kSimdTile.width(); ++x) {
      if (here.status(x, y) != there.status(x, y)) {
        ++otherwise;
        continue;
      }
      const double angle_here = here.sigma_normal_deg(x, y), angle_there = there.sigma_normal_deg(x, y);
      normal_deg = std::max(normal_deg, angle_deg(here.normal(x, y), there.normal(x, y)));
      sigma = std::max(sigma, std::abs(angle_here - angle_there) / (angle_there + 0.01));
      for (int p = 0; p < planes; ++p) {
        albedo = std::max<double>(
            albedo, std::abs(here.albedo(x, y, p) - there.albedo(x, y, p)) / (there.albedo(x, y, p) + 1e-3));
      }
    }
  }
  EXPECT_LE(radians(normal_deg), bound);
  EXPECT_LE(albedo, bound);
  EXPECT_LE(sigma, bound == kPlainBound ? kSigmaRelativeBound : kDoubtedSigmaRelativeBound);
  EXPECT_LE(otherwise, kShareOnAThreshold * static_cast<double>(kSimdTile.pixels()));
}

TEST(SimdTargets, AgreeWithinTheStatedBoundForEveryMethod) {
  const LightField field =
      *LightField::make(test::ten_leds(1.3), overhead_camera(kSimdSize, 600, 0.3), kSimdSize, 2);
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    const auto solved_on = [&](std::int64_t target) {
      Trial trial(field, kSimdTile, planes, [](int x, int y) {
        Random random(static_cast<std::uint64_t>(y) * 1000 + static_cast<std::uint64_t>(x));
        const Vec3 n = test::random_normal(random, 45);
        return Truth{n, {0.02 + 0.9 * random.uniform(), 0.3, 0.2}};
      });
      trial.add_noise({2e-5, 1e-8, 0}, 7);
      for (int x = 0; x < kSimdTile.width(); x += 3)
        trial.reading(static_cast<std::size_t>(x) % 10)(x, 1) = std::numeric_limits<float>::infinity();
      hwy::SetSupportedTargetsForTest(target);
      trial.solve(method, planes == 1 ? std::optional(NoiseModel{2e-5, 1e-8, 0}) : std::nullopt);
      hwy::SetSupportedTargetsForTest(0);
      return trial;
    };
    const Trial first = solved_on(targets.front());
    for (const std::int64_t target : targets) {
      SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes, " << hwy::TargetName(target)
                                      << " against " << hwy::TargetName(targets.front()));
      expect_within_bound(solved_on(target), first, planes,
                          test::promise_of(name).one_weight ? kPlainBound : kRejectingBound);
    }
  });
}

}  // namespace
}  // namespace weft
