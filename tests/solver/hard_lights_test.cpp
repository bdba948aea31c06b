// SPDX-License-Identifier: Apache-2.0
// Lights that are hard to solve from, each case by its number in docs/numerics.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bench/oracles/hard_lights.h"
#include "bench/oracles/oracle_rig.h"
#include "bench/oracles/quad_oracle.h"
#include "core/rig/light_field.h"
#include "solver/in_double/pixel.h"
#include "tests/solver/tiles.h"

namespace weft {
namespace {

using test::hard_field;
using test::kHardSize;
using test::kHardTile;
using test::kNaN;
using test::oracle_of;
using test::OracleRow;
using test::OracleSolution;
using test::Random;
using test::Trial;
using test::Truth;

// Normals up to `most_deg` from where a cluster of lights points.
std::function<Truth(int, int)> facing_the_cluster(double most_deg) {
  return [most_deg](int x, int y) {
    Random random(static_cast<std::uint64_t>(y) * 1000 + static_cast<std::uint64_t>(x));
    const Vec3 z = test::random_normal(random, most_deg), axis = test::cluster_axis();
    const Vec3 across = {0, 1, 0}, up = cross(axis, across);
    return Truth{z.x * across + z.y * up + z.z * axis, {0.3, 0.5, 0.2}};
  };
}

// What float32 may be wrong by. Above a condition number of 30 nothing is left to it.
double bar_deg(double condition) {
  return condition <= 3 ? 1e-4 : condition <= 20 ? 5e-3 : condition <= solver::kFloatCondition ? 1e-2 : 1e-4;
}

constexpr std::array kConditions = {1.5, 3.0, 10.0, 20.0, 29.0, 100.0, 1e3, 1e4, 1e5, 5e5};

TEST(HardCase01ClosingUpLights, ThreeOfThemAreSolvedWithinTheBarByEveryMethod) {
  for (const double condition : kConditions) {
    const LightField field = hard_field(test::clustered_lights(3, condition));
    test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
      SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes, condition " << condition);
      Trial trial(field, kHardTile, planes, facing_the_cluster(10));
      trial.solve(method);
      double worst_deg = 0;
      for (int x = 0; x < kHardTile.width(); x += 3) {
        const OracleSolution exact = oracle_of(trial, planes, x, 1);
        worst_deg = std::max(worst_deg, angle_deg(trial.normal(x, 1), exact.normal));
        ASSERT_EQ(trial.status(x, 1), kZeroDof) << x;
      }
      EXPECT_LT(worst_deg, bar_deg(condition));
    });
  }
}

TEST(HardCase01ClosingUpLights, SixOfThemAreSolvedWithinTheBarByEveryPlainSumOfSquares) {
  for (const double condition : kConditions) {
    const LightField field = hard_field(test::clustered_lights(6, condition));
    test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
      if (!test::promise_of(name).one_weight) return;
      SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes, condition " << condition);
      Trial trial(field, kHardTile, planes, facing_the_cluster(10));
      trial.solve(method);
      double worst_deg = 0;
      for (int x = 0; x < kHardTile.width(); x += 3) {
        const OracleSolution exact = oracle_of(trial, planes, x, 1);
        worst_deg = std::max(worst_deg, angle_deg(trial.normal(x, 1), exact.normal));
        ASSERT_EQ(trial.status(x, 1), 0) << x;
      }
      EXPECT_LT(worst_deg, bar_deg(condition));
    });
  }
}

TEST(HardCase01ClosingUpLights, AreSolvedAndFlaggedFromAMillionToAHundredMillion) {
  for (const double condition_beside : {1e5, 1e7, 1e8}) {
    const LightField field = test::coplanar_field(condition_beside);
    const Rect tile = {test::kLinePixel, 0, test::kLinePixel + 100, 1};
    test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
      SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes, " << condition_beside);
      Trial trial(field, tile, planes, [](int, int) {
        return Truth{{-0.5, 0, std::sqrt(0.75)}, {0.3, 0.5, 0.2}};
      });
      for (int x = 0; x < tile.width(); ++x) {
        for (std::size_t k = 3; k < 6; ++k) trial.reading(k)(x, 0) = kNaN;
      }
      trial.solve(method);
      EXPECT_EQ(trial.status(0, 0), kInvalidReading | kNoSolution) << "on the line itself";
      for (int x = 1; x < tile.width(); ++x) {
        const OracleSolution exact = oracle_of(trial, planes, x, 0);
        ASSERT_LT(angle_deg(trial.normal(x, 0), exact.normal), 1e-4)
            << "condition " << exact.condition << " at " << x;
        const bool ill = exact.condition >= kIllConditionedFrom;
        if (std::abs(exact.condition / kIllConditionedFrom - 1) < 1e-6) continue;
        ASSERT_EQ(trial.status(x, 0) & ~kSpecular, kInvalidReading | kZeroDof | (ill ? kIllConditioned : 0))
            << "condition " << exact.condition << " at " << x;
      }
    });
  }
}

// Triples and sextuples of every condition number, in double, by the factorisation that it asks for.
TEST(HardCase01ClosingUpLights, AreSolvedInDoubleByTheFactorisationThatTheyAskFor) {
  for (double condition = 2; condition < 1.1e8; condition *= std::sqrt(10)) {
    for (const std::size_t count : {3U, 6U}) {
      // Past 1e7 no six directions that are exact in float32 are that close: doubles are.
      DistantLights lights = test::clustered_lights(count, std::min(condition, 1e7));
      std::vector<solver::PixelRow> rows;
      std::vector<OracleRow> exact_rows;
      Random random(7);
      const Vec3 axis = test::cluster_axis();
      const double closer = std::max(1.0, condition / 1e7);
      for (const DistantLight& light : lights.lights) {
        const Vec3 l =
            normalized(axis + (1 / closer) * (light.direction - dot(light.direction, axis) * axis));
        const double reading = 0.4 * dot(normalized(axis + Vec3{0.1, 0.05, 0}), l);
        rows.push_back({l, {1, 1, 1}, {reading, reading, reading}});
        exact_rows.push_back({l, 1, reading});
      }
      const OracleSolution exact = test::solve_in_quad(exact_rows);
      const solver::PixelSolution ours = solver::solve_pixel(rows, {});
      SCOPED_TRACE(testing::Message() << count << " lights, condition " << exact.condition);
      EXPECT_LT(angle_deg(ours.normal, exact.normal), 1e-4);
      EXPECT_NEAR(ours.albedo[0] / exact.albedo, 1, 1e-6);
      EXPECT_EQ((ours.status & kIllConditioned) != 0, exact.condition >= kIllConditionedFrom);
      EXPECT_EQ(ours.path == solver::EquationsSolvedBy::kSvd, exact.condition >= kIllConditionedFrom);
      if (exact.condition > 1.5 * solver::kDoubleCondition) {
        EXPECT_NE(ours.path, solver::EquationsSolvedBy::kNormalEquations);
      }
    }
  }
}

// A ring of four, and one of its lights over again.
DistantLights four_and_a_double() {
  DistantLights lights = test::clustered_lights(4, 2);
  lights.lights.push_back(lights.lights[1]);
  return lights;
}

TEST(HardCase02DoubledLights, CountTwice) {
  const LightField field = hard_field(four_and_a_double());
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    if (!test::promise_of(name).one_weight) return;
    SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes");
    Trial trial(field, kHardTile, planes, facing_the_cluster(10));
    trial.add_noise({1e-4, 0, 0}, 5);  // else no weight would matter
    for (int p = 0; p < planes; ++p) {
      for (int x = 0; x < kHardTile.width(); ++x) trial.reading(4, p)(x, 0) = trial.reading(1, p)(x, 0);
    }
    trial.solve(method);
    for (int x = 0; x < kHardTile.width(); ++x) {
      std::vector<OracleRow> rows = test::oracle_rows(trial.rows(x, 0), planes);
      rows.pop_back();
      rows[1].weight = 2;
      const OracleSolution exact = test::solve_in_quad(rows);
      ASSERT_LT(angle_deg(trial.normal(x, 0), exact.normal), 1e-4) << x;
      const solver::PixelSolution in_double = solver::solve_pixel(trial.rows(x, 0), {planes, false, {}});
      ASSERT_LT(angle_deg(in_double.normal, exact.normal), 1e-9) << x;
    }
  });
}

TEST(HardCase02DoubledLights, TenOfThemAreRefusedByName) {
  DistantLights lights;
  for (int k = 0; k < 10; ++k) lights.lights.push_back({test::cluster_axis(), {1, 1, 1}});
  const Result<LightField> field = LightField::make(lights, std::nullopt, kHardSize, 0);
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(field.error().message(),
              testing::AllOf(testing::HasSubstr("10 lights"), testing::HasSubstr("condition number inf")));
}

TEST(HardCase02DoubledLights, WithoutOtherReadingsLeaveNoSolution) {
  DistantLights lights = test::clustered_lights(3, 2);
  for (int k = 0; k < 7; ++k) lights.lights.push_back(lights.lights[0]);
  const LightField field = hard_field(lights);
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes");
    Trial trial(field, kHardTile, planes, facing_the_cluster(10));
    for (int x = 0; x < kHardTile.width(); ++x) {
      trial.reading(1)(x, 0) = trial.reading(2)(x, 0) = kNaN;  // eight copies of one light
      trial.reading(1)(x, 1) = kNaN;                           // and one other: rank two
    }
    trial.solve(method);
    for (int x = 0; x < kHardTile.width(); ++x) {
      for (int y = 0; y < 2; ++y) {
        ASSERT_EQ(trial.status(x, y), kInvalidReading | kNoSolution) << x << ", " << y;
        ASSERT_EQ(trial.normal(x, y), (Vec3{0, 0, 1}));
        ASSERT_TRUE(std::isfinite(trial.albedo(x, y)));
      }
    }
  });
}

TEST(HardCase03FewerThanThreeLights, GiveTheBestAlbedoOfALevelCloth) {
  const LightField field = hard_field(test::clustered_lights(5, 2));
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    for (std::size_t left = 0; left < 3; ++left) {
      SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes, " << left << " lights");
      Trial trial(field, kHardTile, planes, facing_the_cluster(10));
      for (std::size_t k = left; k < 5; ++k) {
        for (int x = 0; x < kHardTile.width(); ++x) trial.reading(k, planes - 1)(x, 0) = kNaN;
      }
      trial.solve(method);
      for (int x = 0; x < kHardTile.width(); ++x) {
        ASSERT_EQ(trial.status(x, 0), kInvalidReading | kNoSolution) << x;
        ASSERT_EQ(trial.normal(x, 0), (Vec3{0, 0, 1})) << x;
        ASSERT_EQ(trial.sigma_normal_deg(x, 0), solver::kUnknownAngleDeg) << x;
        for (int p = 0; p < planes; ++p) {
          double sum = 0, weight = 0;
          for (std::size_t k = 0; k < left; ++k) {
            const solver::PixelRow row = trial.rows(x, 0)[k];
            sum += row.direction.z * row.reading[static_cast<std::size_t>(p)];
            weight += row.direction.z * row.direction.z;
          }
          ASSERT_NEAR(trial.albedo(x, 0, p), weight > 0 ? sum / weight : 0, 1e-6) << x << ", plane " << p;
        }
      }
    }
  });
}

TEST(HardCase04ThreeLights, GiveWhatCramersRuleGives) {
  const NearLights leds = test::ten_leds();
  Random random(4);
  for (int i = 0; i < 12; ++i) {
    std::vector<int> numbers;
    while (numbers.size() < 3) {
      const int number = 1 + static_cast<int>(random.uniform() * 10);
      if (std::count(numbers.begin(), numbers.end(), number) == 0) numbers.push_back(number);
    }
    const LightField field =
        *LightField::make(*select_lights(leds, numbers), overhead_camera(kHardSize, 600, 0.3), kHardSize, 0);
    test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
      SCOPED_TRACE(testing::Message() << name << ", " << planes << " planes, LEDs " << numbers[0] << ' '
                                      << numbers[1] << ' ' << numbers[2]);
      Trial trial(field, kHardTile, planes, [](int, int) {
        return Truth{normalized({0.1, -0.05, 1}), {0.3, 0.5, 0.2}};
      });
      trial.solve(method);
      for (int x = 0; x < kHardTile.width(); x += 7) {
        const std::vector<OracleRow> rows = test::oracle_rows(trial.rows(x, 0), planes);
        const OracleSolution exact = test::solve_by_cramer(std::span<const OracleRow, 3>(rows));
        ASSERT_LE(exact.condition, 16.5);
        ASSERT_LT(angle_deg(trial.normal(x, 0), exact.normal), exact.condition <= 3 ? 1e-4 : 5e-3) << x;
        ASSERT_EQ(trial.status(x, 0), kZeroDof) << x;
        ASSERT_EQ(trial.sigma_normal_deg(x, 0), solver::kUnknownAngleDeg) << "no scatter, no noise model";
        const solver::PixelSolution in_double = solver::solve_pixel(trial.rows(x, 0), {planes, false, {}});
        ASSERT_LT(angle_deg(in_double.normal, exact.normal), 1e-9) << x;
      }
    });
  }
}

TEST(HardCase04ThreeLights, HaveTheSigmaOfTheNoiseModel) {
  const LightField field = hard_field(test::clustered_lights(3, 2));
  const NoiseModel noise = {0, 1e-6, 0};
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    if (planes == 3) return;
    SCOPED_TRACE(name);
    Trial trial(field, kHardTile, 1, facing_the_cluster(10));
    trial.solve(method, noise);
    for (int x = 0; x < kHardTile.width(); ++x) {
      // Columns of A^-1 by cross products; the noise of each reading goes through one of them.
      const std::vector<solver::PixelRow> rows = trial.rows(x, 0);
      const Vec3 a = rows[0].direction, b = rows[1].direction, c = rows[2].direction;
      const double determinant = dot(a, cross(b, c));
      const Vec3 n = facing_the_cluster(10)(x, 0).normal;
      double across2 = 0, along2 = 0;
      for (const Vec3 column : {cross(b, c), cross(c, a), cross(a, b)}) {
        const double along = dot(column, n) / determinant;
        along2 += noise.floor * along * along;
        across2 += noise.floor * (dot(column, column) / (determinant * determinant) - along * along);
      }
      const double rho = trial.albedo(x, 0);
      ASSERT_NEAR(trial.sigma_normal_deg(x, 0) / degrees(std::sqrt(across2) / rho), 1, 1e-3) << x;
      ASSERT_NEAR(trial.sigma_albedo(x, 0) / std::sqrt(along2), 1, 1e-3) << x;
    }
  });
}

TEST(HardCase13LedsInTheCloth, AreRefusedByName) {
  for (const double height_mm : {5.9, 5.0, 0.0, -3.0}) {
    NearLights leds = test::ten_leds();
    leds.leds[6].position_mm.z = height_mm;
    const Result<LightField> field =
        LightField::make(leds, overhead_camera(kHardSize, 600, 0.3), kHardSize, 5);
    ASSERT_FALSE(field) << height_mm;
    EXPECT_THAT(field.error().message(),
                testing::AllOf(testing::HasSubstr("LED 7"), testing::HasSubstr("the cloth 5.0 mm")));
  }
}

TEST(HardCase13LedsInTheCloth, AHandBreadthOfAirIsEnough) {
  NearLights leds = test::ten_leds();
  leds.leds[6].position_mm = {0.1, 0.1, 6.1};  // 1.1 mm above a pixel, ten thousand times as bright there
  leds.leds[6].aim = {0, 0, -1};
  const LightField field = *LightField::make(leds, overhead_camera(kHardSize, 600, 0.3), kHardSize, 5);
  test::for_each_method([&](const solver::Method& method, const std::string& name, int planes) {
    const Rect tile = {64, 0, 64 + 128, 8};
    Trial trial(field, tile, planes, [](int, int) { return Truth{{0, 0, 1}, {0.3, 0.5, 0.2}}; });
    trial.solve(method);
    for (int y = 0; y < tile.height(); ++y) {
      for (int x = 0; x < tile.width(); ++x) {
        ASSERT_LT(trial.error_deg(x, y), 1e-3) << name << ", " << planes << " planes, " << x << ", " << y;
        ASSERT_NEAR(trial.albedo(x, y) / (planes == 1 ? 1 : 0.3), planes == 1 ? trial.albedo(x, y) : 1, 1e-4);
      }
    }
  });
}

}  // namespace
}  // namespace weft
