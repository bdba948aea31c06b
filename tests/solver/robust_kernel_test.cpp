// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <hwy/targets.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/kernels/weighted.h"
#include "solver/reference/pixel.h"
#include "tests/support/rig.h"

namespace weft {
namespace {

using solver::Estimator;
using test::Random;
using test::Trial;
using test::Truth;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

const Size kSize = {640, 480};
const Rect kTile = {64, 33, 64 + 131, 33 + 16};
const NoiseModel kNoise = {2e-5, 1e-8, 1e-8};

LightField field_of(const NearLights& lights) {
  return *LightField::make(lights, overhead_camera(kSize, 600, 0.3), kSize, 2);
}

NearLights fewer_leds(std::size_t count) {
  NearLights lights = test::ten_leds();
  lights.leds.resize(count);
  return lights;
}

// Ten LEDs and some of a third ring.
NearLights more_leds(std::size_t count) {
  NearLights lights = test::ten_leds();
  for (std::size_t i = 10; i < count; ++i) {
    const double azimuth = radians(40.0 * static_cast<double>(i)), zenith = radians(48);
    NearLight led = lights.leds[0];
    led.position_mm = {600 * std::sin(zenith) * std::cos(azimuth),
                       600 * std::sin(zenith) * std::sin(azimuth), 600 * std::cos(zenith)};
    led.aim = -1.0 / 600 * led.position_mm;
    lights.leds.push_back(led);
  }
  return lights;
}

std::function<Truth(int, int)> cloth(double most_deg) {
  return [most_deg](int x, int y) {
    Random random(static_cast<std::uint64_t>(y) * 1000 + static_cast<std::uint64_t>(x));
    const Vec3 n = test::random_normal(random, most_deg);
    return Truth{
        n, {0.05 + 0.9 * random.uniform(), 0.05 + 0.9 * random.uniform(), 0.05 + 0.9 * random.uniform()}};
  };
}

Truth flat_grey(int, int) {
  return {normalized({0.1, 0.05, 1}), {0.3, 0.3, 0.3}};
}

// Highlights, cast shadows, and readings that are full, missing or known to be in shadow.
void spoil(Trial& trial, Rect tile, int lights, int planes, std::uint64_t seed) {
  Random random(seed);
  for (int y = 0; y < tile.height(); ++y) {
    for (int x = 0; x < tile.width(); ++x) {
      while (random.uniform() < 0.4) {
        const auto k = static_cast<std::size_t>(random.uniform() * lights);
        const double kind = random.uniform(), much = random.uniform();
        for (int p = 0; p < planes; ++p) {
          float& r = trial.reading(k, p)(x, y);
          if (kind < 0.5) {
            r = static_cast<float>(static_cast<double>(r) * (1 + 4 * much));
          } else if (kind < 0.8) {
            r = static_cast<float>(static_cast<double>(r) * 0.5 * much);
          } else {
            r = kind < 0.87 ? kInfinity : kind < 0.94 ? kNaN : -kInfinity;
          }
        }
      }
    }
  }
}

template <typename Check>
void on_every_target(Check check) {
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    SCOPED_TRACE(hwy::TargetName(target));
    check();
  }
  hwy::SetSupportedTargetsForTest(0);
}

class Kernel : public solver::Method {
 public:
  explicit Kernel(Estimator estimator, double trim_from = solver::kTrimFrom)
      : estimator_(estimator), trim_from_(trim_from) {}
  void solve(const solver::TileInput& input, const solver::TileOutput& output) const override {
    solver::TileOutput counted = output;
    tally = {};
    counted.tally = &tally;
    solver::solve_weighted(input, counted, estimator_, trim_from_);
  }
  solver::PixelOptions options(int planes, const std::optional<NoiseModel>& noise) const {
    return {planes, true, noise, estimator_, trim_from_};
  }
  mutable solver::SolveTally tally;

 private:
  Estimator estimator_;
  double trim_from_;
};

bool is_near(double a, double b, double relative, double absolute) {
  return std::abs(a - b) <= relative * std::abs(b) + absolute;
}

bool is_as(const Trial& trial, const solver::PixelSolution& truth, int planes, int x, int y) {
  bool same = angle_deg(trial.normal(x, y), truth.normal) < 2e-3 && trial.status(x, y) == truth.status &&
              is_near(trial.sigma_normal_deg(x, y), truth.sigma_normal_deg, 2e-3, 1e-3) &&
              is_near(trial.residual(x, y), truth.residual, 2e-3, 1e-5);
  for (int p = 0; p < planes; ++p) {
    const auto c = static_cast<std::size_t>(p);
    same = same && is_near(trial.albedo(x, y, p), truth.albedo[c], 1e-4, 1e-6) &&
           is_near(trial.sigma_albedo(x, y, p), truth.sigma_albedo[c], 2e-3, 1e-5);
  }
  return same;
}

// A reading that lies on a threshold to seven digits may fall to either side, and all else follows: so many
// of all pixels.
constexpr double kShareThatDecidesOtherwise = 1.0 / 2000;

void expect_as_reference(const NearLights& lights, const Kernel& kernel, int planes,
                         const std::optional<NoiseModel>& noise) {
  const LightField field = field_of(lights);
  Trial trial(field, kTile, planes, cloth(60));
  trial.add_noise(kNoise, 7);
  spoil(trial, kTile, static_cast<int>(field.count()), planes, 3);
  solver::PixelSolver reference(kernel.options(planes, noise));
  std::vector<solver::PixelSolution> truth;
  for (int y = 0; y < kTile.height(); ++y) {
    for (int x = 0; x < kTile.width(); ++x) truth.push_back(reference.solve(trial.rows(x, y)));
  }
  std::int64_t rejected = 0;
  for (const solver::PixelSolution& s : truth) rejected += s.rejected;
  on_every_target([&] {
    trial.solve(kernel, noise);
    int otherwise = 0;
    std::size_t i = 0;
    for (int y = 0; y < kTile.height(); ++y) {
      for (int x = 0; x < kTile.width(); ++x, ++i) {
        if (is_as(trial, truth[i], planes, x, y)) continue;
        ++otherwise;
        SCOPED_TRACE(testing::Message() << "pixel " << x << ", " << y);
        RecordProperty("first_otherwise", x);
        if (getenv("VERBOSE")) printf("%d %d: %g deg status %x %x sigma %g %g residual %g %g albedo %g %g\n",x,y,angle_deg(trial.normal(x, y), truth[i].normal),trial.status(x,y),truth[i].status,trial.sigma_normal_deg(x,y),truth[i].sigma_normal_deg,trial.residual(x,y),truth[i].residual,trial.albedo(x,y,0),truth[i].albedo[0]);
      }
    }
    const auto pixels = static_cast<double>(kTile.pixels());
    EXPECT_LE(otherwise, std::max(1.0, kShareThatDecidesOtherwise * pixels));
    EXPECT_NEAR(static_cast<double>(kernel.tally.rejected_readings), static_cast<double>(rejected),
                5.0 * otherwise);
    EXPECT_GT(static_cast<double>(kernel.tally.by_kernel), 0.7 * pixels);
  });
}

TEST(WeightedKernel, AgreesWithItsReferenceOnEveryTarget) {
  for (const Estimator estimator : {Estimator::kWeighted, Estimator::kRejecting}) {
    SCOPED_TRACE(static_cast<int>(estimator));
    expect_as_reference(test::ten_leds(), Kernel(estimator), 1, kNoise);
    expect_as_reference(test::ten_leds(), Kernel(estimator), 1, std::nullopt);
    expect_as_reference(test::ten_leds(), Kernel(estimator), 3, std::nullopt);
  }
}

TEST(TrimmedKernel, AgreesWithItsReferenceOnEveryTarget) {
  for (const double trim_from : {solver::kTrimFrom, 0.0}) {
    SCOPED_TRACE(trim_from);
    expect_as_reference(test::ten_leds(), Kernel(Estimator::kTrimmed, trim_from), 1, kNoise);
    expect_as_reference(test::ten_leds(), Kernel(Estimator::kTrimmed, trim_from), 1, std::nullopt);
    expect_as_reference(test::ten_leds(), Kernel(Estimator::kTrimmed, trim_from), 3, std::nullopt);
  }
}

}  // namespace
}  // namespace weft
