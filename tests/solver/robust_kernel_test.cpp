// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/oracles/oracle_rig.h"
#include "solver/in_double/pixel.h"
#include "solver/kernels/weighted.h"
#include "tests/simd_targets.h"
#include "tests/solver/tiles.h"

namespace weft {
namespace {

using solver::Estimator;
using test::cloth;
using test::cloth_field;
using test::kClothTile;
using test::kInfinity;
using test::kNaN;
using test::on_every_target;
using test::Random;
using test::Trial;
using test::Truth;

const NoiseModel kNoise = {2e-5, 1e-8, 1e-8};

// The first of ten LEDs, or all and some of a ring between.
NearLights leds(std::size_t count) {
  NearLights lights = test::ten_leds();
  lights.leds.resize(std::min<std::size_t>(count, 10));
  for (std::size_t i = 10; i < count; ++i) {
    const double azimuth = radians(40.0 * static_cast<double>(i)), zenith = radians(48);
    NearLight led = lights.leds[0];
    led.position_mm = {600 * std::sin(zenith) * std::cos(azimuth), 600 * std::sin(zenith) * std::sin(azimuth),
                       600 * std::cos(zenith)};
    led.aim = -1.0 / 600 * led.position_mm;
    lights.leds.push_back(led);
  }
  return lights;
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
  const LightField field = cloth_field(lights);
  Trial trial(field, kClothTile, planes, cloth(60));
  trial.add_noise(kNoise, 7);
  spoil(trial, kClothTile, static_cast<int>(field.count()), planes, 3);
  solver::PixelSolver reference(kernel.options(planes, noise));
  std::vector<solver::PixelSolution> truth;
  for (int y = 0; y < kClothTile.height(); ++y) {
    for (int x = 0; x < kClothTile.width(); ++x) truth.push_back(reference.solve(trial.rows(x, y)));
  }
  std::int64_t rejected = 0;
  for (const solver::PixelSolution& s : truth) rejected += s.rejected;
  on_every_target([&] {
    trial.solve(kernel, noise);
    int otherwise = 0;
    std::size_t i = 0;
    for (int y = 0; y < kClothTile.height(); ++y) {
      for (int x = 0; x < kClothTile.width(); ++x, ++i) {
        if (!is_as(trial, truth[i], planes, x, y)) ++otherwise;
      }
    }
    const auto pixels = static_cast<double>(kClothTile.pixels());
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

TEST(WeightedKernel, AgreesWithItsReferenceForAnyNumberOfLights) {
  for (const std::size_t count : {4u, 5u, 7u, 15u, 17u}) {
    SCOPED_TRACE(count);
    expect_as_reference(leds(count), Kernel(Estimator::kRejecting), 1, kNoise);
    expect_as_reference(leds(count), Kernel(Estimator::kTrimmed), 1, kNoise);
  }
}

double rms_error_deg(const Trial& trial) {
  double square = 0;
  for (int y = 0; y < kClothTile.height(); ++y) {
    for (int x = 0; x < kClothTile.width(); ++x) square += std::pow(trial.error_deg(x, y), 2);
  }
  return std::sqrt(square / static_cast<double>(kClothTile.pixels()));
}

// The rms error of flat cloth where every pixel's readings were changed by `spoil_pixel(trial, x, y)`.
template <typename Spoil>
double error_deg_after(Spoil spoil_pixel, const Kernel& kernel) {
  const LightField field = cloth_field(test::ten_leds());
  Trial trial(field, kClothTile, 1, flat_grey);
  trial.add_noise(kNoise, 11);
  for (int y = 0; y < kClothTile.height(); ++y) {
    for (int x = 0; x < kClothTile.width(); ++x) spoil_pixel(trial, x, y);
  }
  trial.solve(kernel, kNoise);
  return rms_error_deg(trial);
}

TEST(Standard, LeavesOutOneHighlightOfTen) {
  const auto nothing = [](Trial&, int, int) {};
  const auto highlight = [](Trial& trial, int x, int y) {
    trial.reading(static_cast<std::size_t>(x % 10))(x, y) *= 2;
  };
  const double clean = error_deg_after(nothing, Kernel(Estimator::kRejecting));
  const Kernel rejecting(Estimator::kRejecting);
  EXPECT_LT(error_deg_after(highlight, rejecting), 1.15 * clean) << "of nine readings instead of ten";
  EXPECT_GE(rejecting.tally.rejected_readings, kClothTile.pixels());
  EXPECT_GT(error_deg_after(highlight, Kernel(Estimator::kWeighted)), 5 * clean);
}

TEST(Standard, LeavesOutACastShadow) {
  const auto nothing = [](Trial&, int, int) {};
  for (const float left : {0.0f, 0.5f}) {
    const auto shadow = [left](Trial& trial, int x, int y) {
      trial.reading(static_cast<std::size_t>(x % 10))(x, y) *= left;
    };
    EXPECT_LT(error_deg_after(shadow, Kernel(Estimator::kRejecting)),
              1.15 * error_deg_after(nothing, Kernel(Estimator::kRejecting)))
        << "light left: " << left;
  }
}

TEST(Standard, KeepsAllReadingsOfMostCleanPixels) {
  const Kernel kernel(Estimator::kRejecting);
  error_deg_after([](Trial&, int, int) {}, kernel);
  const double rejecting =
      static_cast<double>(kernel.tally.rejected_readings) / static_cast<double>(kClothTile.pixels());
  EXPECT_GT(rejecting, 0.003);
  EXPECT_LT(rejecting, 0.035);
}

TEST(Robust, LeavesOutThreeHighlightsOfTen) {
  const auto nothing = [](Trial&, int, int) {};
  const auto highlights = [](Trial& trial, int x, int y) {
    for (const int k : {0, 1, 4}) trial.reading(static_cast<std::size_t>((x + k) % 10))(x, y) *= 2.5f;
  };
  const double clean = error_deg_after(nothing, Kernel(Estimator::kTrimmed));
  EXPECT_LT(error_deg_after(highlights, Kernel(Estimator::kTrimmed)), 2 * clean);
  EXPECT_GT(error_deg_after(highlights, Kernel(Estimator::kRejecting)), 10 * clean);
}

void expect_same_bits(const Trial& a, int ax, int ay, const Trial& b, int bx, int by) {
  ASSERT_EQ(a.normal(ax, ay), b.normal(bx, by));
  ASSERT_EQ(a.albedo(ax, ay), b.albedo(bx, by));
  ASSERT_EQ(a.sigma_normal_deg(ax, ay), b.sigma_normal_deg(bx, by));
  ASSERT_EQ(a.sigma_albedo(ax, ay), b.sigma_albedo(bx, by));
  ASSERT_EQ(a.residual(ax, ay), b.residual(bx, by));
  ASSERT_EQ(a.status(ax, ay), b.status(bx, by));
}

// Every seventh pixel asks for what the six beside it do not.
void expect_same_bits_beside(const Kernel& kernel, int planes) {
  const LightField field = cloth_field(test::ten_leds());
  Trial alone(field, kClothTile, planes, cloth(30)), beside(field, kClothTile, planes, cloth(30));
  alone.add_noise(kNoise, 5);
  beside.add_noise(kNoise, 5);
  for (int x = 0; x < kClothTile.width(); x += 7) {
    for (int y = 0; y < kClothTile.height(); ++y) {
      beside.reading(3)(x, y) *= y % 4 == 0 ? 3.0f : 1.0f;
      beside.reading(5)(x, y) *= y % 4 <= 1 ? 4.0f : 1.0f;
      beside.reading(7)(x, y) = y % 4 == 2 ? kNaN : 0;
    }
  }
  on_every_target([&] {
    alone.solve(kernel, kNoise);
    beside.solve(kernel, kNoise);
    for (int y = 0; y < kClothTile.height(); ++y) {
      for (int x = 0; x < kClothTile.width(); ++x) {
        SCOPED_TRACE(testing::Message() << planes << " planes, pixel " << x << ", " << y);
        if (x % 7 != 0) expect_same_bits(alone, x, y, beside, x, y);
      }
    }
  });
}

TEST(WeightedKernel, GivesTheSameBitsWhateverThePixelBeside) {
  for (const int planes : {1, 3}) {
    expect_same_bits_beside(Kernel(Estimator::kWeighted), planes);
    expect_same_bits_beside(Kernel(Estimator::kRejecting), planes);
    expect_same_bits_beside(Kernel(Estimator::kTrimmed), planes);
    expect_same_bits_beside(Kernel(Estimator::kTrimmed, 0.0), planes);
  }
}

TEST(TrimmedKernel, IsStandardToTheBitWhereNothingAsks) {
  const LightField field = cloth_field(test::ten_leds());
  Trial standard(field, kClothTile, 1, cloth(30)), robust(field, kClothTile, 1, cloth(30));
  standard.add_noise(kNoise, 5);
  robust.add_noise(kNoise, 5);
  for (int x = 0; x < kClothTile.width(); x += 7) robust.reading(5)(x, 3) *= 5;
  on_every_target([&] {
    standard.solve(Kernel(Estimator::kRejecting), kNoise);
    robust.solve(Kernel(Estimator::kTrimmed, 6.0), kNoise);
    for (int x = 0; x < kClothTile.width(); ++x) {
      SCOPED_TRACE(x);
      if (x % 7 != 0) expect_same_bits(standard, x, 3, robust, x, 3);
    }
  });
}

TEST(WeightedKernel, GivesTheSameBitsAtAnyWidth) {
  const LightField field = cloth_field(test::ten_leds());
  const auto solved = [&](int width) {
    const Rect tile = {kClothTile.x0, kClothTile.y0, kClothTile.x0 + width, kClothTile.y0 + 2};
    Trial trial(field, tile, 1, cloth(45));
    for (int x = 0; x < width; ++x)
      trial.reading(static_cast<std::size_t>(x % 9))(x, 1) *= x % 3 == 0 ? 3.0f : 1.0f;
    const Kernel kernel(Estimator::kTrimmed);
    trial.solve(kernel, kNoise);
    return std::pair(std::move(trial), kernel.tally.rejected_readings);
  };
  on_every_target([&] {
    const auto [whole, most] = solved(131);
    std::int64_t before = 0;
    for (const int width : {1, 2, 3, 5, 7, 8, 9, 15, 16, 17, 31, 33, 47, 63, 64, 65, 100, 127, 129, 130}) {
      const auto [part, rejected] = solved(width);
      SCOPED_TRACE(testing::Message() << "width " << width);
      for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < width; ++x) expect_same_bits(whole, x, y, part, x, y);
      }
      EXPECT_GE(rejected, before);
      EXPECT_LE(rejected, most);
      before = rejected;
    }
    EXPECT_GT(most, 0);
  });
}

TEST(WeightedKernel, ForgetsTheFieldOfTheTileBefore) {
  DistantLights distant;
  for (const NearLight& led : test::ten_leds().leds)
    distant.lights.push_back({normalized(led.position_mm), {1, 2, 0.7}});
  NearLights near = test::ten_leds(1.3);
  near.leds[2].log_gain_quadratic = {0.1, 0.2, 0.1, 0, 0, 0};
  near.log_gain_rgb[0] = near.log_gain_rgb[1] = near.log_gain_rgb[2] = {4, 4, std::vector<double>(16, 0.1)};
  const LightField far_field = *LightField::make(distant, std::nullopt, test::kClothSize, 0),
                   near_field = cloth_field(near);
  Trial first(far_field, kClothTile, 1, cloth(45)), between(near_field, kClothTile, 1, cloth(45)),
      after(far_field, kClothTile, 1, cloth(45));
  const Kernel kernel(Estimator::kRejecting);
  first.solve(kernel, kNoise);
  between.solve(kernel, kNoise);
  after.solve(kernel, kNoise);
  for (int x = 0; x < kClothTile.width(); ++x) {
    SCOPED_TRACE(x);
    expect_same_bits(first, x, 3, after, x, 3);
    ASSERT_LT(first.error_deg(x, 3), 1e-3);
    ASSERT_LT(between.error_deg(x, 3), 1e-3);
  }
}

TEST(WeightedKernel, CountsEveryPixelOnce) {
  const LightField field = cloth_field(test::ten_leds());
  Trial trial(field, kClothTile, 1, flat_grey);
  for (std::size_t k = 0; k < 10; ++k) {
    if (k > 0) trial.reading(k)(3, 4) = kNaN;
    if (k > 2) trial.reading(k)(5, 4) = kInfinity;
    trial.reading(k)(6, 4) = -kInfinity;
  }
  trial.reading(8)(7, 4) *= 2;
  const Kernel kernel(Estimator::kRejecting);
  trial.solve(kernel, kNoise);
  const solver::SolveTally& t = kernel.tally;
  EXPECT_EQ(t.unsolved, 2);
  EXPECT_EQ(t.by_kernel + t.by_normal_equations + t.by_qr + t.by_svd + t.unsolved, kClothTile.pixels());
  EXPECT_EQ(t.by_kernel, kClothTile.pixels() - 2);
  EXPECT_EQ(t.rejected_readings, 1);
  EXPECT_EQ(trial.status(3, 4), kInvalidReading | kNoSolution);
  EXPECT_EQ(trial.status(5, 4), kSaturated | kZeroDof);
  EXPECT_EQ(trial.status(6, 4), kShadowed | kNoSolution);
}

TEST(WeightedKernel, WeighsReadingsOverTwelveDecadesOfIntensity) {
  for (const double decade : {-6.0, -3.0, 3.0, 6.0}) {
    NearLights lights = test::ten_leds();
    const double factor = std::pow(10, decade);
    for (NearLight& led : lights.leds) {
      for (double& flux : led.flux_rgb) flux *= factor;
    }
    const LightField field = cloth_field(lights), usual = cloth_field(test::ten_leds());
    const NoiseModel noise = {kNoise.per_reading * factor, kNoise.floor * factor * factor,
                              kNoise.shared * factor * factor};
    for (const Estimator estimator : {Estimator::kWeighted, Estimator::kRejecting, Estimator::kTrimmed}) {
      Trial scaled(field, kClothTile, 1, cloth(45)), unscaled(usual, kClothTile, 1, cloth(45));
      for (Trial* trial : {&scaled, &unscaled}) {
        for (int x = 0; x < kClothTile.width(); x += 2) trial->reading(3)(x, 2) *= 3;
      }
      const Kernel kernel(estimator);
      unscaled.solve(kernel, kNoise);
      scaled.solve(kernel, noise);
      EXPECT_EQ(kernel.tally.by_kernel, kClothTile.pixels()) << "decade " << decade;
      for (int x = 0; x < kClothTile.width(); ++x) {
        ASSERT_LT(angle_deg(scaled.normal(x, 2), unscaled.normal(x, 2)), 1e-4) << "decade " << decade;
        ASSERT_NEAR(scaled.sigma_normal_deg(x, 2) / unscaled.sigma_normal_deg(x, 2), 1, 1e-4);
      }
    }
  }
}

}  // namespace
}  // namespace weft
