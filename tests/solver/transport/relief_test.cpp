// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/relief.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace weft::solver {
namespace {

TEST(Relief, RefusesHeightsThatAreNone) {
  Image<float> height_mm({6, 4});
  const auto why = [&](double mm_per_pixel) {
    const auto relief = Relief::of(height_mm.plane(), mm_per_pixel);
    if (relief) return std::string("accepted");
    EXPECT_EQ(relief.error().kind, ErrorKind::kBadData);
    return relief.error().why;
  };
  EXPECT_EQ(why(0.04), "accepted");
  EXPECT_EQ(why(0), "0 mm a pixel");
  EXPECT_EQ(why(std::numeric_limits<double>::infinity()), "inf mm a pixel");
  height_mm(5, 3) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(why(0.04), "the height of pixel (5, 3) is nan mm");
  height_mm(5, 3) = -std::numeric_limits<float>::infinity();
  EXPECT_EQ(why(0.04), "the height of pixel (5, 3) is -inf mm");
  height_mm(5, 3) = 400;
  EXPECT_EQ(why(0.04), "heights differ by 10000 pixels");
  EXPECT_EQ(why(0.05), "accepted");
  EXPECT_FALSE(Relief::of({}, 0.04));
}

}  // namespace
}  // namespace weft::solver
