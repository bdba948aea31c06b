// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace weft::bench {
namespace {

constexpr std::uint32_t kCoverageSeed = 5;

// Errors of two Gaussian components, with sigmas over a decade; each is stated `padded` times too large.
std::vector<StatedError> gaussian(double padded) {
  std::mt19937 random(kCoverageSeed);
  std::normal_distribution<double> component(0, std::sqrt(0.5));
  std::vector<StatedError> pixels(20000);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double sigma = 0.1 * std::pow(10, static_cast<double>(i) / static_cast<double>(pixels.size()));
    pixels[i].error_deg = static_cast<float>(sigma * std::hypot(component(random), component(random)));
    pixels[i].sigma_deg = static_cast<float>(padded * sigma);
  }
  return pixels;
}

TEST(Coverage, OfGaussianErrorsOfTheStatedSizeHolds) {
  const Json row = coverage_of(gaussian(1));
  EXPECT_NEAR(row["median_over_sigma"], std::sqrt(std::log(2)), 0.02) << "seed " << kCoverageSeed;
  EXPECT_LT(row["beyond_3"], 0.001);
  EXPECT_TRUE(row["holds"]);
  EXPECT_TRUE(row["each_tenth_holds"]);
}

TEST(Coverage, OfAPaddedSigmaDoesNotHold) {
  EXPECT_FALSE(coverage_of(gaussian(2))["holds"]) << "too large";
  EXPECT_FALSE(coverage_of(gaussian(0.3))["holds"]) << "too small";
}

TEST(Coverage, SeesThatOneNumberForAllPixelsIsNotTrueOfEachTenth) {
  std::vector<StatedError> pixels = gaussian(1);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i].sigma_deg = i < pixels.size() / 10 ? 0.39F : 0.4F;  // the best tenth is known, and not how good
  }
  const Json row = coverage_of(pixels);
  EXPECT_FALSE(row["each_tenth_holds"]) << row;
  EXPECT_LT(row["worst_tenth"], 0.4);
}

TEST(Coverage, LeavesFlaggedPixelsOutUpToAFifth) {
  std::vector<StatedError> pixels = gaussian(1);
  for (std::size_t i = 0; i < pixels.size(); i += 6) {
    pixels[i].error_deg = 90;
    pixels[i].status = kSpecular;
  }
  const Json few = coverage_of(pixels);
  EXPECT_NEAR(few["flagged"], 1 / 6.0, 1e-3);
  EXPECT_TRUE(few["left_out"]);
  EXPECT_TRUE(few["holds"]);
  for (std::size_t i = 1; i < pixels.size(); i += 6) pixels[i].status = kSaturated;
  const Json many = coverage_of(pixels);
  EXPECT_FALSE(many["left_out"]);
  EXPECT_FALSE(many["holds"]) << "every sixth is 90 degrees off";
}

TEST(Coverage, HoldsOnAPlainClothThatNoiseAloneDoesNotExplain) {
  AccuracyTableOptions options;
  options.quick = true;
  options.scene = "plain lambert";
  options.methods = {"standard"};
  options.threads = 1;
  const Result<Rows> rows = coverage_table(options);
  ASSERT_TRUE(rows.has_value()) << rows.error().message();
  ASSERT_EQ(rows->size(), 1U);
  EXPECT_TRUE(rows->front()["holds"]) << rows->front();
  EXPECT_TRUE(rows->front()["each_tenth_holds"]) << rows->front();
}

TEST(Coverage, RefusesALevelThatIsNotThere) {
  AccuracyTableOptions options;
  options.methods = {"finest"};
  const Result<Rows> rows = coverage_table(options);
  ASSERT_FALSE(rows.has_value());
  EXPECT_EQ(rows.error().where, "finest");
}

}  // namespace
}  // namespace weft::bench
