// SPDX-License-Identifier: Apache-2.0
#include "solver/registration/cloth_shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/vec.h"

namespace weft::solver {
namespace {

constexpr Size kFrame = {192, 96};
constexpr Rect kAll = {0, 0, kFrame.width, kFrame.height};

double wave(double x, double y, double period) {
  return 1 + 0.4 * std::sin(2 * kPi * x / period + 0.3) * std::cos(2 * kPi * y / period);
}

// A frame whose cloth lies `shift` off.
Image<float> moved(const ClothShift& shift, double period) {
  Image<float> image(kFrame);
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      const auto d = shift.at(x - (kFrame.width - 1) / 2.0, y - (kFrame.height - 1) / 2.0);
      image(x, y) = static_cast<float>(wave(x - d.x, y - d.y, period));
    }
  }
  return image;
}

Image<float> resampled(const Image<float>& source, const ClothShift& shift, Rect tile, int step) {
  Image<float> out({tile.width(), tile.height()});
  resample(source.plane(), kAll, shift, tile, kFrame, step, out.plane());
  return out;
}

TEST(ClothShift, MovesRightDownAndTurnsFromRightTowardsUp) {
  const ClothShift shift = {1, 2, 0.01};
  EXPECT_DOUBLE_EQ(shift.at(100, 0).x, 1);
  EXPECT_DOUBLE_EQ(shift.at(100, 0).y, 1);  // what lies right of the centre goes up
  EXPECT_DOUBLE_EQ(shift.at(0, 100).x, 2);  // what lies below it goes right
}

TEST(ClothShift, IsUndoneToAHundredthOnAWaveOfTwelvePixels) {
  for (const int step : {1, 2}) {
    const ClothShift shift = {0.5, -1.3, 1e-4};
    const Image<float> back = resampled(moved(shift, 12), shift, kAll, step);
    double worst = 0;
    for (int y = 10; y < kFrame.height - 10; ++y) {
      for (int x = 10; x < kFrame.width - 10; ++x)
        worst = std::max(worst, std::abs(double{back(x, y)} - wave(x, y, 12)));
    }
    EXPECT_LT(worst, 0.01) << "step " << step;
  }
}

TEST(ClothShift, ByWholeCellsCopiesExactly) {
  const Image<float> source = moved({}, 7);
  const Image<float> out = resampled(source, {4, -2, 0}, kAll, 2);
  for (int y = 2; y < kFrame.height; ++y) {
    for (int x = 0; x + 4 < kFrame.width; ++x) ASSERT_EQ(out(x, y), source(x + 4, y - 2));
  }
  EXPECT_TRUE(std::isnan(out(0, 0)));
  EXPECT_TRUE(std::isnan(out(kFrame.width - 1, 50)));
}

TEST(ClothShift, KeepsColoursApartAndSpreadsWhatCannotBeUsedWithinItsColour) {
  Image<float> source(kFrame);
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) source(x, y) = static_cast<float>((x & 1) + 2 * (y & 1));
  }
  source(60, 40) = std::numeric_limits<float>::infinity();
  source(100, 40) = std::numeric_limits<float>::quiet_NaN();
  const Image<float> out = resampled(source, {0.7, 0.6, 0}, kAll, 2);
  for (int y = 10; y < kFrame.height - 10; ++y) {
    for (int x = 10; x < kFrame.width - 10; ++x) {
      const auto touched = [&](int hole) {
        return (x & 1) == 0 && (y & 1) == 0 && std::abs(x - hole) <= 6 && std::abs(y - 40) <= 6;
      };
      if (std::isfinite(out(x, y))) {
        EXPECT_NEAR(out(x, y), (x & 1) + 2 * (y & 1), 1e-5) << x << ", " << y;
      } else {
        EXPECT_TRUE(touched(60) || touched(100)) << x << ", " << y;
      }
    }
  }
  EXPECT_FALSE(std::isfinite(out(60, 40)));
  EXPECT_FALSE(std::isfinite(out(100, 40)));
}

TEST(ClothShift, GivesTheSameBytesForAnyTile) {
  const ClothShift shift = {0.37, -2.61, 2e-3};
  const Image<float> source = moved(shift, 9), whole = resampled(source, shift, kAll, 2);
  for (const Rect tile : {Rect{64, 10, 192, 13}, Rect{62, 32, 100, 61}}) {
    const Rect seen = seen_through(shift, tile, kFrame, 2);
    Image<float> part({seen.width(), seen.height()}), out({tile.width(), tile.height()});
    for (int y = seen.y0; y < seen.y1; ++y) {
      for (int x = seen.x0; x < seen.x1; ++x) part(x - seen.x0, y - seen.y0) = source(x, y);
    }
    resample(part.plane(), seen, shift, tile, kFrame, 2, out.plane());
    for (int y = tile.y0; y < tile.y1; ++y) {
      for (int x = tile.x0; x < tile.x1; ++x) {
        const float a = out(x - tile.x0, y - tile.y0), b = whole(x, y);
        ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace weft::solver
