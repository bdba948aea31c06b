// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/weave.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace weft::simulator {
namespace {

constexpr double kAmplitude_mm = 0.01, kSpacing_mm = 0.05, kLength_mm = 16;

Fibres fibres(std::int64_t seed, std::uint32_t stream = 0, double angle = 0.3) {
  return {kAmplitude_mm, kSpacing_mm, angle, kLength_mm, 32, seed, stream};
}

template <typename Body>
void for_each_place(const Body& body) {
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) body(-0.3 + 0.0101 * i, -3 + 0.1003 * j);
  }
}

TEST(Fibres, AreTheSameForTheSameSeedOnly) {
  const Fibres a = fibres(5), again = fibres(5), other_seed = fibres(6), other_set = fibres(5, 1);
  double by_seed = 0, by_set = 0, by_yarn = 0;
  for_each_place([&](double across, double along) {
    const double here = a.at(3, across, along).height_mm;
    ASSERT_EQ(again.at(3, across, along).height_mm, here);
    by_seed = std::max(by_seed, std::abs(other_seed.at(3, across, along).height_mm - here));
    by_set = std::max(by_set, std::abs(other_set.at(3, across, along).height_mm - here));
    by_yarn = std::max(by_yarn, std::abs(a.at(4, across, along).height_mm - here));
  });
  for (const double difference : {by_seed, by_set, by_yarn}) EXPECT_GT(difference, kAmplitude_mm / 2);
}

TEST(Fibres, KeepTheirAmplitudeAndHaveNoMean) {
  const Fibres relief = fibres(5);
  double highest = 0, sum = 0, squares = 0;
  for_each_place([&](double across, double along) {
    const double h = relief.at(-7, across, along).height_mm;
    highest = std::max(highest, std::abs(h));
    sum += h / 3600;
    squares += h * h / 3600;
  });
  EXPECT_LE(highest, kAmplitude_mm);
  EXPECT_NEAR(sum, 0, 0.05 * kAmplitude_mm);
  EXPECT_NEAR(std::sqrt(squares), kAmplitude_mm / 4, 0.05 * kAmplitude_mm) << "eight waves of random phase";
}

TEST(Fibres, HaveTheSlopeOfTheirHeight) {
  const Fibres relief = fibres(9);
  constexpr double kStep_mm = 1e-6;
  double steepest = 0;
  for_each_place([&](double u, double v) {
    const Fibres::Relief r = relief.at(11, u, v);
    const auto height = [&](double du, double dv) { return relief.at(11, u + du, v + dv).height_mm; };
    ASSERT_NEAR(r.across, (height(kStep_mm, 0) - height(-kStep_mm, 0)) / (2 * kStep_mm), 1e-7);
    ASSERT_NEAR(r.along, (height(0, kStep_mm) - height(0, -kStep_mm)) / (2 * kStep_mm), 1e-7);
    steepest = std::max(steepest, std::hypot(r.across, r.along));
  });
  EXPECT_LE(steepest, relief.steepest_slope());
  EXPECT_GT(steepest, relief.steepest_slope() / 3);
}

TEST(Fibres, RunAtTheirAngleAndRepeatAtTheEndOfTheCloth) {
  const Fibres relief = fibres(2);
  double along_fibre = 0, across_fibre = 0;
  for_each_place([&](double u, double v) {
    const Fibres::Relief r = relief.at(1, u, v);
    along_fibre += std::pow(r.across * std::sin(0.3) + r.along * std::cos(0.3), 2);
    across_fibre += std::pow(r.across * std::cos(0.3) - r.along * std::sin(0.3), 2);
    ASSERT_NEAR(relief.at(1, u, v + kLength_mm).height_mm, r.height_mm, 1e-12);
    ASSERT_NEAR(relief.at(1 - 32, u, v).height_mm, r.height_mm, 1e-15);
  });
  EXPECT_LT(along_fibre, 0.02 * across_fibre) << "a fibre is long";
}

}  // namespace
}  // namespace weft::simulator
