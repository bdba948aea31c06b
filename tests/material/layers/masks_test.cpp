// SPDX-License-Identifier: Apache-2.0
#include "material/layers/masks.h"

#include <gtest/gtest.h>

#include <cmath>

namespace weft::material {
namespace {

ParameterField ramp(int width) {
  Image<float> map({width, 2});
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < width; ++x) map(x, y) = static_cast<float>(x);
  }
  return ParameterField::of(std::move(map));
}

TEST(Masks, ByHeightHaveASoftEdge) {
  const ParameterField mask = height_mask(ramp(11), 5, 4);
  EXPECT_EQ(mask.at(3, 0), 0);
  EXPECT_DOUBLE_EQ(mask.at(5, 0), 0.5);
  EXPECT_EQ(mask.at(7, 0), 1);
  // 3 t^2 - 2 t^3 at a quarter.
  EXPECT_NEAR(mask.at(4, 0), 3.0 / 16 - 2.0 / 64, 1e-7);
  const ParameterField hard = height_mask(ramp(11), 5, 0);
  EXPECT_EQ(hard.at(5, 0), 0);
  EXPECT_EQ(hard.at(6, 0), 1);
}

TEST(Masks, OfACavityAreFullWhereItIsDeep) {
  Image<float> map({64, 64});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) map(x, y) = x / 8 % 2 == 0 ? 0.0f : 0.4f;
  }
  Result<ParameterField> mask =
      cavity_mask(ParameterField::of(std::move(map)), {.mm_per_pixel = 0.1, .radius_mm = 2, .is_tile = true});
  ASSERT_TRUE(mask);
  ASSERT_TRUE(level(*mask, {.zero = 0.5, .one = 0}));
  EXPECT_GT(mask->at(4, 9), 0.2);
  EXPECT_EQ(mask->at(12, 9), 0);
}

TEST(Masks, OfAConstantHeightAreTheSameEverywhere) {
  Result<ParameterField> flat = cavity_mask(ParameterField::same(3), {.mm_per_pixel = 0.1});
  ASSERT_TRUE(flat);
  EXPECT_FALSE(flat->is_map());
  EXPECT_EQ(flat->constant[0], 0.5);
}

TEST(Masks, AreLevelledAndTurnedOver) {
  ParameterField mask = ramp(11);
  ASSERT_TRUE(level(mask, {.zero = 8, .one = 4}));
  EXPECT_EQ(mask.at(10, 0), 0);
  EXPECT_DOUBLE_EQ(mask.at(6, 0), 0.5);
  EXPECT_EQ(mask.at(0, 1), 1);
  EXPECT_FALSE(level(mask, {.zero = 1, .one = 1}));
}

}  // namespace
}  // namespace weft::material
