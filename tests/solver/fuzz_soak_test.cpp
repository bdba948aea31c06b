// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/solver/fuzz.h"

namespace weft {
namespace {

TEST(FuzzSoak, NoMethodMakesNonsenseOfTenMillionPixelsOfRubbish) {
  test::expect_sound_from_rubbish(10'000'000, 1'000'000);
}

}  // namespace
}  // namespace weft
