// SPDX-License-Identifier: Apache-2.0
#include "material/maps/curl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/statistics.h"
#include "core/solve/solve_record.h"
#include "tests/material/maps/slopes.h"

namespace weft::material {
namespace {

Curl curl_of(const TestSlopes& s, const CurlOptions& options = {}, View<const float> sigma_deg = {},
             View<const std::uint16_t> status = {}) {
  Result<Curl> found = curl(s.right.plane(), s.up.plane(), sigma_deg, status, options);
  if (!found) {
    ADD_FAILURE() << found.error().message();
    return {Image<float>(s.right.size())};
  }
  return std::move(found).value();
}

/// |z| of one square by the formula, with the same sigma everywhere.
double z_of(const TestSlopes& s, int x, int y, double sigma_deg) {
  double circulation = 0, variance = 0;
  const int corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int k = 0; k < 4; ++k) {
    const int ax = x + corner[k][0], ay = y + corner[k][1];
    const int bx = x + corner[(k + 1) % 4][0], by = y + corner[(k + 1) % 4][1];
    circulation += (double{s.right(ax, ay)} + s.right(bx, by)) / 2 * (bx - ax);
    circulation -= (double{s.up(ax, ay)} + s.up(bx, by)) / 2 * (by - ay);
    const double steep = 1 + double{s.right(ax, ay)} * s.right(ax, ay) + double{s.up(ax, ay)} * s.up(ax, ay);
    variance += std::pow(radians(sigma_deg) / std::sqrt(2.0) * steep, 2) / 2;
  }
  return std::abs(circulation) / std::sqrt(variance);
}

TEST(Curl, IsTheMedianOfTheCirculationsInTheWindow) {
  TestSlopes s = weave_slopes({70, 60}, 14);
  add_noise(s, 0.8, 3);
  const Curl found = curl_of(s, {.yarn_px = 8, .usual_sigma_deg = 0.5});
  ASSERT_EQ(found.window_px, 11);
  std::vector<double> all;
  for (int y = 0; y + 1 < 60; ++y) {
    for (int x = 0; x + 1 < 70; ++x) all.push_back(z_of(s, x, y, 0.5));
  }
  for (const auto& [x, y] : {std::pair{30, 30}, {0, 0}, {69, 59}, {5, 58}, {40, 11}}) {
    std::vector<double> window;
    for (int v = std::max(y - 5, 0); v < std::min(y + 5, 59); ++v) {
      for (int u = std::max(x - 5, 0); u < std::min(x + 5, 69); ++u) window.push_back(z_of(s, u, v, 0.5));
    }
    EXPECT_NEAR(found.median(x, y), median(window), kCurlStep) << x << ", " << y;
  }
  EXPECT_NEAR(found.frame_median, median(all), kCurlStep);
}

TEST(Curl, OfNoiseAloneIsTheMedianOfANormalNumber) {
  TestSlopes s = level_slopes({400, 300});
  add_noise(s, 0.3, 5);
  const Curl found = curl_of(s, {.usual_sigma_deg = 0.3});
  EXPECT_NEAR(found.frame_median, 0.6745, 0.02);
  EXPECT_FALSE(found.is_of_no_surface());
  EXPECT_EQ(found.flagged_share, 0);
}

TEST(Curl, FlagsEverySquareThatWasPaintedAndNothingElse) {
  for (const int side : {50, 90}) {
    for (const bool is_flipped : {true, false}) {
      TestSlopes s = weave_slopes({420, 360}, 20.75, {.turn_deg = 20});
      add_noise(s, 0.25, 9);
      const int x0 = 130, y0 = 110;
      for (int y = y0; y < y0 + side; ++y) {
        for (int x = x0; x < x0 + side; ++x) {
          // A green channel with the wrong sign; or what lies elsewhere, its two slopes changed over.
          if (is_flipped)
            s.up(x, y) = -s.up(x, y);
          else
            std::swap(s.right(x, y), s.up(x, y));
        }
      }
      const Curl found = curl_of(s, {.yarn_px = 20.75, .usual_sigma_deg = 0.25});
      const int half = found.window_px / 2;
      std::int64_t missed = 0, wrong = 0, elsewhere = 0;
      for (int y = 0; y < 360; ++y) {
        for (int x = 0; x < 420; ++x) {
          const int depth = std::min({x - x0, y - y0, x0 + side - 1 - x, y0 + side - 1 - y});
          const bool is_flagged = double{found.median(x, y)} > kCurlLimit;
          missed += depth >= half && !is_flagged;
          elsewhere += depth < -half;
          wrong += depth < -half && is_flagged;
        }
      }
      EXPECT_EQ(missed, 0) << side << (is_flipped ? " flipped" : " changed over");
      EXPECT_LE(static_cast<double>(wrong), 0.001 * static_cast<double>(elsewhere));
      EXPECT_GT(found.flagged_share, 0);
      EXPECT_FALSE(found.is_of_no_surface()) << found.frame_median;
    }
  }
}

TEST(Curl, SaysWhatTheFlaggedPixelsWere) {
  TestSlopes s = weave_slopes({200, 150}, 20, {.turn_deg = 20});
  for (int y = 0; y < 150; ++y) {
    for (int x = 0; x < 200; ++x) s.up(x, y) = -s.up(x, y);
  }
  Image<std::uint16_t> status(s.right.size());
  for (int y = 0; y < 150; ++y) {
    for (int x = 0; x < 200; ++x) status(x, y) = x < 50 ? kSpecular : kShadowed;
  }
  const Curl found = curl_of(s, {}, {}, status.plane());
  EXPECT_TRUE(found.is_of_no_surface()) << found.frame_median;
  EXPECT_NEAR(found.flagged_share, 1, 0.02);
  EXPECT_NEAR(found.specular_share, 0.25, 0.02);
  EXPECT_NEAR(found.shadowed_share, 0.75, 0.02);
}

TEST(Curl, LeavesOutWhatHasNoSlopeAndGoesOnAroundATile) {
  TestSlopes s = weave_slopes({80, 80}, 20);
  Image<std::uint16_t> status(s.right.size());
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 80; ++x) {
      if (x < 40) status(x, y) = kNoSolution, s.right(x, y) = 1e6f;
    }
  }
  s.up(60, 60) = std::numeric_limits<float>::quiet_NaN();
  const Curl found = curl_of(s, {}, {}, status.plane());
  EXPECT_EQ(found.median(10, 40), 0);
  EXPECT_LT(found.median(60, 40), 1.5);
  EXPECT_TRUE(std::isfinite(found.median(60, 60)));

  // A weave of whole periods moved around the tile moves its map.
  const TestSlopes here = weave_slopes({60, 40}, 10), there = moved(here, 7, 13);
  const Curl a = curl_of(here, {.yarn_px = 10, .is_tile = true});
  const Curl b = curl_of(there, {.yarn_px = 10, .is_tile = true});
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 60; ++x) ASSERT_EQ(a.median(x, y), b.median((x + 7) % 60, (y + 13) % 40));
  }
}

TEST(Curl, HasTheSameBytesOnAnyNumberOfThreadsAndRefusesWhatDoesNotFit) {
  TestSlopes s = weave_slopes({150, 200}, 12);
  add_noise(s, 1, 4);
  const Curl one = curl_of(s, {.threads = 1}), many = curl_of(s, {.threads = 7});
  EXPECT_TRUE(same_floats(one.median, many.median));
  EXPECT_EQ(one.frame_median, many.frame_median);
  const Image<float> other({10, 10});
  EXPECT_FALSE(curl(s.right.plane(), other.plane(), {}, {}, {}));
  EXPECT_FALSE(curl(s.right.plane(), s.up.plane(), other.plane(), {}, {}));
  EXPECT_FALSE(curl(s.right.plane(), s.up.plane(), {}, {}, {.yarn_px = -1}));
  EXPECT_FALSE(curl({}, {}, {}, {}, {}));
}

}  // namespace
}  // namespace weft::material
