// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/registration.h"

#include <gtest/gtest.h>

namespace weft::solver {
namespace {

TEST(ClothShift, MovesRightDownAndTurnsFromRightTowardsUp) {
  const ClothShift shift = {1, 2, 0.01};
  EXPECT_DOUBLE_EQ(shift.at(100, 0).x, 1);
  EXPECT_DOUBLE_EQ(shift.at(100, 0).y, 1);  // what lies right of the centre goes up
  EXPECT_DOUBLE_EQ(shift.at(0, 100).x, 2);  // what lies below it goes right
}

}  // namespace
}  // namespace weft::solver
