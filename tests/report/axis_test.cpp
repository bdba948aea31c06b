// SPDX-License-Identifier: Apache-2.0
#include "report/plot_svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace weft::report {
namespace {

std::vector<double> ticks(double low, double high, bool log) {
  return PlotAxis{.low = low, .high = high, .log = log}.ticks();
}

auto are(const std::vector<double>& values) {
  return testing::Pointwise(testing::DoubleNear(1e-12), values);
}

TEST(PlotAxis, PutsItsEndsWhereItIsToldAndTheMiddleBetween) {
  const PlotAxis linear = {.low = 2, .high = 6, .from = 100, .to = 20},
                 log = {.low = 0.1, .high = 1000, .from = 0, .to = 400, .log = true};
  EXPECT_DOUBLE_EQ(linear.at(2), 100);
  EXPECT_DOUBLE_EQ(linear.at(6), 20);
  EXPECT_DOUBLE_EQ(linear.at(3), 80);
  EXPECT_DOUBLE_EQ(log.at(0.1), 0);
  EXPECT_DOUBLE_EQ(log.at(1000), 400);
  EXPECT_DOUBLE_EQ(log.at(10), 200) << "the geometric mean is drawn in the middle";
}

TEST(PlotAxis, LeavesSixPercentAroundTheValues) {
  const PlotAxis linear = PlotAxis::around(std::vector<double>{30, -20, 80}, false, 0, 112);
  EXPECT_DOUBLE_EQ(linear.low, -26);
  EXPECT_DOUBLE_EQ(linear.high, 86);
  EXPECT_NEAR(linear.at(-20), 6, 1e-12);
  const PlotAxis log = PlotAxis::around(std::vector<double>{1e4, 1}, true, 0, 112);
  EXPECT_NEAR(std::log10(log.low), -0.24, 1e-12);
  EXPECT_NEAR(std::log10(log.high), 4.24, 1e-12);
}

TEST(PlotAxis, TakesOnlyWhatItCanShow) {
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const std::vector<double> values = {kNoNumber, -5, 0, 1, 100, kInfinite};
  const PlotAxis linear = PlotAxis::around(values, false, 0, 1), log = PlotAxis::around(values, true, 0, 1);
  EXPECT_LT(linear.low, -5);
  EXPECT_GT(linear.high, 100);
  EXPECT_LT(linear.high, 110);
  EXPECT_NEAR(log.low, std::pow(10, -0.12), 1e-12) << "0 and below have no logarithm";
  EXPECT_TRUE(linear.takes(-5));
  EXPECT_FALSE(linear.takes(kNoNumber));
  EXPECT_FALSE(log.takes(0));
  EXPECT_FALSE(log.takes(kInfinite));
}

TEST(PlotAxis, OfNothingOrOfOneValueHasALength) {
  for (const std::vector<double>& values : std::vector<std::vector<double>>{{}, {7}, {0}, {-3, -3}}) {
    for (const bool log : {false, true}) {
      const PlotAxis axis = PlotAxis::around(values, log, 0, 1);
      EXPECT_LT(axis.low, axis.high) << values.size() << " values, logarithmic: " << log;
      EXPECT_FALSE(axis.ticks().empty()) << axis.low << " to " << axis.high << ", logarithmic: " << log;
    }
  }
}

TEST(AxisTicks, AreRoundNumbersOnALinearAxis) {
  EXPECT_THAT(ticks(0, 1, false), are({0, 0.2, 0.4, 0.6, 0.8, 1.0}));
  EXPECT_THAT(ticks(-0.3, 4.9, false), are({0, 1, 2, 3, 4}));
  EXPECT_THAT(ticks(-26, 86, false), are({-20, 0, 20, 40, 60, 80}));
  EXPECT_THAT(ticks(1200, 1500, false), are({1200, 1300, 1400, 1500}));
}

TEST(AxisTicks, AreThreeToNineOnAnyLinearAxis) {
  for (double length = 1; length < 1000; length *= 1.01) {
    for (const double low : {0.0, -0.37 * length, 3 * length}) {
      const std::vector<double> values = ticks(low, low + length, false);
      EXPECT_GE(values.size(), 3U) << low << " to " << low + length;
      EXPECT_LE(values.size(), 9U) << low << " to " << low + length;
    }
  }
}

TEST(AxisTicks, AreDigitsOrDecadesOnALogarithmicAxis) {
  EXPECT_THAT(ticks(0.9, 12, true), are({1, 1.5, 2, 3, 4, 5, 6, 8, 10}));
  EXPECT_THAT(ticks(0.9, 120, true), are({1, 2, 5, 10, 20, 50, 100}));
  EXPECT_THAT(ticks(0.5, 1e5, true), are({1.0, 10.0, 100.0, 1e3, 1e4, 1e5}));
  EXPECT_THAT(ticks(6.75, 7.35, true), are({6.8, 6.9, 7.0, 7.1, 7.2, 7.3}))
      << "between two digits there would be nothing to read";
}

}  // namespace
}  // namespace weft::report
