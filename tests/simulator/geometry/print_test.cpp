// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/print.h"

#include <gtest/gtest.h>

#include <limits>

namespace weft::simulator {
namespace {

/// Red grows to the right, green downwards, blue is constant.
PrintSettings ramps() {
  auto albedo = std::make_shared<Image<float>>(Size{4, 3}, 3);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      (*albedo)(x, y, 0) = 0.125f * static_cast<float>(x);
      (*albedo)(x, y, 1) = 0.25f * static_cast<float>(y);
      (*albedo)(x, y, 2) = 0.75f;
    }
  }
  return {albedo, {2, 0, 0, 0, false}};
}

TEST(Print, IsBilinearBetweenSamples) {
  const Print print(ramps());
  for (double column = 0; column <= 3; column += 0.3) {
    for (double row = 0; row <= 2; row += 0.4) {
      const Rgb a = print.at(2 * (column - 1.5), 2 * (1 - row)).value();
      ASSERT_NEAR(a[0], 0.125 * column, 1e-12) << column << ", " << row;
      ASSERT_NEAR(a[1], 0.25 * row, 1e-12) << column << ", " << row;
      ASSERT_NEAR(a[2], 0.75, 1e-12);
    }
  }
}

TEST(Print, EndsAtItsBorderOrRepeats) {
  PrintSettings settings = ramps();
  EXPECT_FALSE(Print(settings).at(4.01, 0).has_value());
  EXPECT_FALSE(Print(settings).at(0, -3.01).has_value());
  EXPECT_EQ(Print(settings).at(3.9, 0).value()[0], 0.375) << "the outer half of the last sample";
  settings.placement.repeats = true;
  const Print print(settings);
  for (double x = -4; x < 4; x += 0.31) {
    const Rgb here = print.at(x, 0.2).value(), next = print.at(x + 16, 0.2 - 6).value();
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(here[c], next[c], 1e-12) << x;
  }
  EXPECT_NEAR(print.at(4, 0).value()[0], 0.1875, 1e-12) << "half-way from the last column to the first";
}

TEST(Print, LiesWhereItIsPut) {
  PrintSettings settings = ramps();
  settings.placement = {2, 10, 20, 90, false};
  const Print print(settings);
  EXPECT_NEAR(print.at(10, 20 + 3).value()[0], 0.375, 1e-12) << "its right is up, turned by 90 degrees";
  EXPECT_NEAR(print.at(10 + 2, 20).value()[1], 0.5, 1e-12) << "its bottom is to the right";
  EXPECT_FALSE(print.at(0, 0).has_value());
}

TEST(Print, IsRefusedOutsideZeroToOne) {
  EXPECT_TRUE(check_print(PrintSettings()));
  EXPECT_FALSE(Print(PrintSettings()).at(0, 0).has_value()) << "nothing printed";
  EXPECT_TRUE(check_print(ramps()));
  for (const float wrong : {-0.1f, 1.5f, std::numeric_limits<float>::quiet_NaN()}) {
    auto albedo = std::make_shared<Image<float>>(Size{2, 2}, 3);
    (*albedo)(1, 0, 2) = wrong;
    const Result<void> refused = check_print({albedo, {}});
    ASSERT_FALSE(refused) << wrong;
    EXPECT_NE(refused.error().message().find("column 1, row 0"), std::string::npos);
  }
  EXPECT_FALSE(check_print({std::make_shared<Image<float>>(Size{2, 2}), {}})) << "one plane";
}

}  // namespace
}  // namespace weft::simulator
