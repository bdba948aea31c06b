// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/light_directions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/transport/cloths.h"

namespace weft::solver {
namespace {

TEST(ShadowReach, IsAsFarAsTheLowestLightAllows) {
  const TestCloth step = cloth_over({30, 3}, [](int x, int) {
    return std::pair{x < 3 ? 10.0 : 0.0, Vec3{0, 0, 1}};
  });
  const LightDirections lights = distant({direction_of(60, 10), direction_of(28, 70)});
  const ShadowReach free = shadow_reach(step.relief(), lights);
  EXPECT_EQ(free.reach_px, std::ceil(10 / std::tan(radians(28))));
  EXPECT_FALSE(free.is_capped);
  const ShadowReach capped = shadow_reach(step.relief(), lights, 15);
  EXPECT_EQ(capped.reach_px, 15);
  EXPECT_TRUE(capped.is_capped);
  EXPECT_TRUE(shadow_reach(step.relief(), distant({{1, 0, 0}})).is_capped);
}

}  // namespace
}  // namespace weft::solver
