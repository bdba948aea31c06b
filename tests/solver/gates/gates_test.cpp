// SPDX-License-Identifier: Apache-2.0
#include "solver/gates/gates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/vec.h"
#include "core/solve/solve_record.h"

namespace weft::solver {
namespace {

constexpr int kSide = 96;

// A sample tile of parallel waves of a given steepest slope, 24 pixels from crest to crest.
class Waves {
 public:
  Waves(double steepest_deg, float albedo)
      : normal_({kSide, kSide}, 3), albedo_({kSide, kSide}), status_({kSide, kSide}) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const double slope = std::tan(radians(steepest_deg)) * std::cos(2 * kPi * x / 24);
        const Vec3 n = normalized({-slope, 0, 1});
        normal_(x, y, 0) = static_cast<float>(n.x);
        normal_(x, y, 2) = static_cast<float>(n.z);
        albedo_(x, y) = albedo;
      }
    }
  }
  SolvedSample sample() {
    return {{normal_.plane(0), normal_.plane(1), normal_.plane(2)},
            albedo_.plane(),
            status_.plane(),
            1000,
            shadowed};
  }
  void mark(std::uint16_t bit, int every) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; x += every) status_(x, y) |= bit;
    }
  }
  std::int64_t shadowed = 0;

 private:
  Image<float> normal_, albedo_;
  Image<std::uint16_t> status_;
};

Gates gates_of(Waves& waves) {
  const SolvedSample sample = waves.sample();
  const Result<Gates> gates = measure_gates({&sample, 1}, {}, AlbedoScale::kAbsolute);
  EXPECT_TRUE(gates) << gates.error().message();
  return *gates;
}

TEST(Gates, AreAllShutOverAWhiteCard) {
  Waves card(0, 0.9f);
  const Gates gates = gates_of(card);
  EXPECT_FALSE(gates.shadows());
  EXPECT_FALSE(gates.interreflection());
  EXPECT_NEAR(gates.slope.value, 0, 1e-6);
  EXPECT_NEAR(gates.indirect.value, 0, 1e-6);
}

TEST(Gates, MeasureTheSlopeOfWaves) {
  Waves waves(40, 0.5f);
  const Gates gates = gates_of(waves);
  // 95 percent of a cosine's phases lie below cos(0.05 * 90 degrees) of its height.
  EXPECT_NEAR(gates.slope.value, degrees(std::atan(std::tan(radians(40)) * std::cos(radians(4.5)))), 0.5);
  EXPECT_TRUE(gates.shadows());
}

TEST(Gates, OpenForBouncesWithTheAlbedoAndNotWithTheSlopeAlone) {
  Waves black(45, 0.02f), white(45, 0.9f);
  EXPECT_FALSE(gates_of(black).interreflection()) << gates_of(black).indirect.value;
  EXPECT_TRUE(gates_of(white).interreflection()) << gates_of(white).indirect.value;
  EXPECT_NEAR(gates_of(white).indirect.value / gates_of(black).indirect.value, 45, 1e-3);
}

TEST(Gates, OpenForShadowsWhereReadingsAreDarkThoughSlopesAreSmall) {
  Waves waves(5, 0.5f);
  EXPECT_FALSE(gates_of(waves).shadows());
  waves.shadowed = 20;
  EXPECT_TRUE(gates_of(waves).shadows());
}

TEST(Gates, StayShutWhereHighlightsDominate) {
  Waves waves(40, 0.9f);
  waves.mark(kSpecular, 4);
  const Gates gates = gates_of(waves);
  EXPECT_NEAR(gates.specular.value, 0.25, 1e-9);
  EXPECT_FALSE(gates.shadows());
  EXPECT_FALSE(gates.interreflection());
}

TEST(Gates, RefuseAClothWithoutASolution) {
  Waves waves(0, 0.5f);
  waves.mark(kNoSolution, 1);
  const SolvedSample sample = waves.sample();
  const Result<Gates> gates = measure_gates({&sample, 1}, {}, AlbedoScale::kAbsolute);
  ASSERT_FALSE(gates);
  EXPECT_EQ(gates.error().kind, ErrorKind::kBadData);
}

}  // namespace
}  // namespace weft::solver
