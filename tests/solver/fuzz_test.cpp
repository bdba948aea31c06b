// SPDX-License-Identifier: Apache-2.0
#include "tests/solver/fuzz.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

TEST(Fuzz, NoMethodMakesNonsenseOf200000PixelsOfRubbish) {
  test::expect_sound_from_rubbish(200'000, 1);
}

}  // namespace
}  // namespace weft
