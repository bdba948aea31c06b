// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/student.h"

#include <gtest/gtest.h>

namespace weft::calibration {
namespace {

// t of `rest` degrees of freedom as a square over the mean of all.
double square_of(double t, double rest) {
  return (rest + 1) * t * t / (rest + t * t);
}

// Two-sided tails by the tables: t of 10 beyond 4.587 is as rare as a normal beyond 3.29 (0.001).
TEST(Student, IsAsRareAsTheTablesSay) {
  EXPECT_NEAR(normal_as_rare(square_of(4.587, 10), 11), 3.2905, 0.01);
  EXPECT_NEAR(normal_as_rare(square_of(2.086, 20), 21), 1.95996, 0.005);
  const double of_two_shots = normal_as_rare(square_of(12.706, 1), 2) / 1.95996;
  EXPECT_GT(of_two_shots, 0.94) << "too low where there is next to nothing to judge by";
  EXPECT_LT(of_two_shots, 1);
}

TEST(Student, OfManyShotsIsNormal) {
  EXPECT_NEAR(normal_as_rare(square_of(5, 1e6), 1e6 + 1), 5, 1e-4);
}

}  // namespace
}  // namespace weft::calibration
