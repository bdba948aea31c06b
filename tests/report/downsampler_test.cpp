// SPDX-License-Identifier: Apache-2.0
#include "report/downsampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>

#include "core/solve/solve_record.h"
#include "tests/report/not_finite.h"

namespace weft::report {
namespace {

Image<float> noise(Size size) {
  std::mt19937 random(11);
  Image<float> image(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) image(x, y) = static_cast<float>(random() % 100'000) * 1e-3f - 40.0f;
  }
  return image;
}

Image<float> constant(Size size, float value) {
  Image<float> image(size);
  for (int y = 0; y < size.height; ++y) std::fill_n(image.plane().row(y), size.width, value);
  return image;
}

void add_whole(Downsampler& downsampler, const Image<float>& image) {
  const std::array<View<const float>, 1> rows = {image.plane()};
  downsampler.add_rows(rows);
}

TEST(Downsampler, KeepsAConstantExactlyAtAnySizeAndSquare) {
  for (const float value : {0.1f, -3.3f, 1e-30f, 3e38f, 16777215.0f}) {
    for (const Size size : {Size{1, 1}, Size{7, 3}, Size{100, 61}, Size{61, 100}}) {
      for (const int side : {1, 2, 9, 40, 1024}) {
        Downsampler downsampler(size, 1, side);
        add_whole(downsampler, constant(size, value));
        const Image<float>& averages = downsampler.averages();
        EXPECT_LE(std::max(averages.width(), averages.height()), side);
        for (int y = 0; y < averages.height(); ++y) {
          for (int x = 0; x < averages.width(); ++x) {
            ASSERT_EQ(averages(x, y), value) << size.width << " x " << size.height << " to " << side;
          }
        }
      }
    }
  }
}

TEST(Downsampler, AveragesEachSquareAndWhatIsLeftAtTheEdges) {
  const Image<float> image = noise({11, 8});
  Downsampler downsampler(image.size(), 1, 4);
  add_whole(downsampler, image);
  ASSERT_EQ(downsampler.square(), 3);
  ASSERT_EQ(downsampler.averages().size(), (Size{4, 3}));
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      double sum = 0;
      int count = 0;
      for (int y = 3 * row; y < std::min(3 * row + 3, 8); ++y) {
        for (int x = 3 * column; x < std::min(3 * column + 3, 11); ++x, ++count) sum += image(x, y);
      }
      EXPECT_NEAR(downsampler.averages()(column, row), sum / count, 1e-5) << column << ", " << row;
    }
  }
}

TEST(Downsampler, GivesTheSameBitsForAnyBands) {
  const Image<float> image = noise({301, 157});
  Downsampler whole(image.size(), 1, 50);
  add_whole(whole, image);
  for (const int band : {1, 2, 7, 64, 156}) {
    Downsampler banded(image.size(), 1, 50);
    for (int y = 0; y < 157; y += band) {
      const std::array<View<const float>, 1> rows = {
          image.plane().crop({0, y, 301, std::min(y + band, 157)})};
      banded.add_rows(rows);
    }
    for (int y = 0; y < whole.averages().height(); ++y) {
      for (int x = 0; x < whole.averages().width(); ++x) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(banded.averages()(x, y)),
                  std::bit_cast<std::uint32_t>(whole.averages()(x, y)))
            << "at " << x << ", " << y << " in bands of " << band;
      }
    }
  }
}

TEST(Downsampler, LeavesOutMissingPixelsAndCountsThem) {
  Image<float> image = constant({8, 4}, 2.0f);
  image(0, 0) = kNan;
  image(1, 1) = -kInf;
  Image<std::uint16_t> status({8, 4});
  image(2, 0) = 1000.0f;
  status(2, 0) = kNoSolution | kShadowed;
  status(3, 3) = kSaturated | kSpecular;  // no reason to leave it out
  Downsampler downsampler(image.size(), 1, 2);
  const std::array<View<const float>, 1> rows = {image.plane()};
  downsampler.add_rows(rows, status.plane());
  EXPECT_EQ(downsampler.averages()(0, 0), 2.0f);
  EXPECT_EQ(downsampler.averages()(1, 0), 2.0f);
  EXPECT_EQ(downsampler.missing(), 3);
}

TEST(Downsampler, LeavesOutAPixelOfWhichOnePlaneIsMissing) {
  Image<float> image({3, 1}, 2);
  for (int x = 0; x < 3; ++x) image(x, 0, 0) = image(x, 0, 1) = static_cast<float>(x);
  image(2, 0, 1) = kNan;
  Downsampler downsampler(image.size(), 2, 1);
  const std::array<View<const float>, 2> rows = {image.plane(0), image.plane(1)};
  downsampler.add_rows(rows);
  EXPECT_EQ(downsampler.averages()(0, 0, 0), 0.5f);
  EXPECT_EQ(downsampler.averages()(0, 0, 1), 0.5f);
}

TEST(Downsampler, IsMissingWhereHalfOfASquareIs) {
  for (const auto& [missing, shown] : {std::pair{7, true}, {8, false}, {16, false}}) {
    Image<float> image = constant({4, 4}, 1.0f);
    for (int i = 0; i < missing; ++i) image(i % 4, i / 4) = kNan;
    Downsampler downsampler(image.size(), 1, 1);
    add_whole(downsampler, image);
    EXPECT_EQ(std::isfinite(downsampler.averages()(0, 0)), shown) << missing << " of 16 missing";
  }
}

TEST(Downsampler, ShowsRowsThatHaveNotComeAsMissing) {
  const Image<float> image = constant({4, 2}, 1.0f);
  Downsampler downsampler({4, 4}, 1, 2);
  add_whole(downsampler, image);
  EXPECT_EQ(downsampler.averages()(0, 0), 1.0f);
  EXPECT_TRUE(std::isnan(downsampler.averages()(0, 1)));
  add_whole(downsampler, image);
  add_whole(downsampler, image);  // beyond the last row
  EXPECT_EQ(downsampler.averages()(0, 1), 1.0f);
}

}  // namespace
}  // namespace weft::report
