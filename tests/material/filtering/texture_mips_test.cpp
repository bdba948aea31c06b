// SPDX-License-Identifier: Apache-2.0
#include "material/filtering/texture_mips.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/vec.h"

namespace weft::material {
namespace {

std::vector<View<const float>> planes_of_texture(const Image<float>& image) {
  std::vector<View<const float>> views;
  for (int p = 0; p < image.planes(); ++p) views.push_back(image.plane(p));
  return views;
}

template <typename Value>
Image<float> texture_of(Size size, int planes, const Value& value) {
  Image<float> image(size, planes);
  for (int p = 0; p < planes; ++p) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) image(x, y, p) = static_cast<float>(value(x, y, p));
    }
  }
  return image;
}

std::vector<Image<float>> chain_of(const Image<float>& image, MipMean mean, int threads = 1) {
  Result<std::vector<Image<float>>> levels = mip_chain(planes_of_texture(image), mean, threads);
  EXPECT_TRUE(levels) << (levels ? "" : levels.error().message());
  return levels ? std::move(*levels) : std::vector<Image<float>>{};
}

double mean_of_plane(const Image<float>& image, int plane = 0) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) sum += static_cast<double>(image(x, y, plane));
  }
  return sum / static_cast<double>(image.size().pixels());
}

TEST(TextureMips, AverageFourTexelsOfEvenSides) {
  const Image<float> image = texture_of({4, 2}, 2, [](int x, int y, int p) { return 10 * p + x + 4 * y; });
  const auto levels = chain_of(image, MipMean::kPlain);
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_FLOAT_EQ(levels[0](0, 0, 0), 2.5F);
  EXPECT_FLOAT_EQ(levels[0](1, 0, 1), 14.5F);
  EXPECT_FLOAT_EQ(levels[1](0, 0, 0), 3.5F);
}

TEST(TextureMips, KeepTheMeanOfEverySize) {
  for (int height = 1; height <= 9; ++height) {
    for (int width = 1; width <= 9; ++width) {
      const Image<float> image = texture_of({width, height}, 1, [](int x, int y, int) {
        return std::sin(1.7 * x + 0.4) * std::cos(2.3 * y) + 0.1 * x * y;
      });
      const auto levels = chain_of(image, MipMean::kPlain);
      Size size = image.size();
      for (const Image<float>& level : levels) {
        size = {std::max(1, size.width / 2), std::max(1, size.height / 2)};
        ASSERT_EQ(level.size(), size);
        ASSERT_NEAR(mean_of_plane(level), mean_of_plane(image), 2e-6)
            << width << " x " << height << " at " << size.width;
      }
      ASSERT_EQ(size.pixels(), 1);
    }
  }
}

TEST(TextureMips, CutAMiddleTexelInHalf) {
  const Image<float> image = texture_of({5, 1}, 1, [](int x, int, int) { return x; });
  const auto levels = chain_of(image, MipMean::kPlain);
  EXPECT_FLOAT_EQ(levels[0](0, 0), static_cast<float>((0 + 1 + 0.5 * 2) / 2.5));
  EXPECT_FLOAT_EQ(levels[0](1, 0), static_cast<float>((0.5 * 2 + 3 + 4) / 2.5));
}

TEST(TextureMips, AverageColourAsLightAndAlphaAsItIs) {
  const Image<float> image = texture_of({2, 1}, 4, [](int x, int, int) { return x; });
  const auto levels = chain_of(image, MipMean::kSrgb);
  // sRGB of half the light.
  for (int p = 0; p < 3; ++p) EXPECT_NEAR(levels[0](0, 0, p), 0.735357, 1e-5) << p;
  EXPECT_FLOAT_EQ(levels[0](0, 0, 3), 0.5F);
}

TEST(TextureMips, AverageNormalsAsSlopes) {
  const double slopes[] = {0.2, 1.4};
  const Image<float> image = texture_of({2, 1}, 3, [&](int x, int, int p) {
    const Vec3 n = normalized(Vec3{-slopes[x], 0.5, 1});
    return p == 0 ? n.x : p == 1 ? n.y : n.z;
  });
  const auto levels = chain_of(image, MipMean::kNormal);
  const Vec3 expected = normalized(Vec3{-0.8, 0.5, 1});
  EXPECT_NEAR(levels[0](0, 0, 0), expected.x, 1e-6);
  EXPECT_NEAR(levels[0](0, 0, 1), expected.y, 1e-6);
  EXPECT_NEAR(levels[0](0, 0, 2), expected.z, 1e-6);
}

TEST(TextureMips, CountSlopesUpToTwenty) {
  const Image<float> image = texture_of(
      {2, 1}, 3, [](int x, int, int p) { return x == 0 ? (p == 0 ? 1.0 : 0.0) : (p == 2 ? 1.0 : 0.0); });
  const auto levels = chain_of(image, MipMean::kNormal);
  EXPECT_NEAR(levels[0](0, 0, 0) / levels[0](0, 0, 2), 10, 1e-4) << "mean of 20 and 0";
}

TEST(TextureMips, LeaveOutWhatIsNoNumber) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const Image<float> plain = texture_of({4, 1}, 1, [&](int x, int, int) { return x == 1 ? 3.0F : kNan; });
  const auto levels = chain_of(plain, MipMean::kPlain);
  EXPECT_EQ(levels[0](0, 0), 3);
  EXPECT_EQ(levels[0](1, 0), 0);
  const Image<float> normal = texture_of({2, 2}, 3, [&](int, int, int) { return kNan; });
  const auto flat = chain_of(normal, MipMean::kNormal);
  EXPECT_EQ(flat[0](0, 0, 0), 0);
  EXPECT_EQ(flat[0](0, 0, 2), 1);
}

TEST(TextureMips, AreTheSameForAnyThreadsAndStopWhereAsked) {
  const Image<float> image = texture_of({61, 43}, 3, [](int x, int y, int p) { return std::sin(x * y + p); });
  const auto one = chain_of(image, MipMean::kPlain, 1), four = chain_of(image, MipMean::kPlain, 4);
  ASSERT_EQ(one.size(), four.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    for (int y = 0; y < one[i].height(); ++y) {
      for (int x = 0; x < one[i].width(); ++x) ASSERT_EQ(one[i](x, y, 2), four[i](x, y, 2)) << i;
    }
  }
  const auto two = mip_chain(planes_of_texture(image), MipMean::kPlain, 1, 2);
  ASSERT_TRUE(two);
  EXPECT_EQ(two->size(), 2U);
  EXPECT_TRUE(chain_of(Image<float>({1, 1}, 3), MipMean::kSrgb).empty());
}

TEST(TextureMips, RefusePlanesThatDoNotFit) {
  const Image<float> four({4, 4}, 4), small({3, 4}), five({4, 4}, 5), none({0, 4}, 3);
  auto planes = planes_of_texture(four);
  EXPECT_FALSE(next_mip(planes, MipMean::kNormal));
  EXPECT_TRUE(next_mip(planes, MipMean::kSrgb));
  planes[1] = small.plane();
  const auto mixed = next_mip(planes, MipMean::kPlain);
  ASSERT_FALSE(mixed);
  EXPECT_EQ(mixed.error().kind, ErrorKind::kUsage);
  EXPECT_FALSE(next_mip(planes_of_texture(five), MipMean::kPlain));
  EXPECT_FALSE(next_mip(planes_of_texture(none), MipMean::kNormal));
  EXPECT_FALSE(next_mip({}, MipMean::kPlain));
  for (const MipMean mean : {MipMean::kPlain, MipMean::kSrgb, MipMean::kNormal}) {
    EXPECT_EQ(mip_mean_named(name_of(mean)), mean);
  }
}

}  // namespace
}  // namespace weft::material
