// SPDX-License-Identifier: Apache-2.0
#include "material/finish/part.h"

#include <gtest/gtest.h>

namespace weft::material {
namespace {

constexpr Size kSize = {7, 5};
constexpr Rect kPart = {2, 1, 6, 4};

// Each value tells its plane and its place.
template <typename T>
Image<T> numbered(int planes) {
  Image<T> map(kSize, planes);
  for (int p = 0; p < planes; ++p) {
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) map(x, y, p) = static_cast<T>(100 * p + 10 * y + x);
    }
  }
  return map;
}

template <typename T>
void expect_part(const Image<T>& out, const Image<T>& of, const char* name) {
  ASSERT_EQ(out.size(), (Size{kPart.width(), kPart.height()})) << name;
  ASSERT_EQ(out.planes(), of.planes()) << name;
  for (int p = 0; p < out.planes(); ++p) {
    for (int y = 0; y < out.height(); ++y) {
      for (int x = 0; x < out.width(); ++x)
        EXPECT_EQ(out(x, y, p), of(kPart.x0 + x, kPart.y0 + y, p)) << name << " at " << x << ", " << y;
    }
  }
}

TEST(Part, HoldsThePixelsOfEveryMap) {
  Surface whole;
  whole.mm_per_pixel = 0.25;
  whole.slope = numbered<float>(2);
  whole.albedo = numbered<float>(3);
  whole.sigma_deg = numbered<float>(1);
  whole.status = numbered<std::uint16_t>(1);
  whole.opacity = numbered<float>(1);
  whole.lobe = numbered<float>(4);
  const Surface part = part_of(whole, kPart);
  EXPECT_EQ(part.mm_per_pixel, 0.25);
  expect_part(part.slope, whole.slope, "slope");
  expect_part(part.albedo, whole.albedo, "albedo");
  expect_part(part.sigma_deg, whole.sigma_deg, "sigma");
  expect_part(part.status, whole.status, "status");
  expect_part(part.opacity, whole.opacity, "opacity");
  expect_part(part.lobe, whole.lobe, "lobe");
}

TEST(Part, HasNoMapThatTheWholeHasNot) {
  Surface whole;
  whole.slope = numbered<float>(2);
  const Surface part = part_of(whole, kPart);
  EXPECT_TRUE(part.opacity.empty());
  EXPECT_TRUE(part.lobe.empty());
}

}  // namespace
}  // namespace weft::material
