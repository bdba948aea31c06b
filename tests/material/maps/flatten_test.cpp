// SPDX-License-Identifier: Apache-2.0
#include "material/maps/flatten.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/solve/solve_record.h"
#include "tests/material/maps/slopes.h"

namespace weft::material {
namespace {

constexpr double kPitch_px = 10, kMmPerPixel = 0.05, kTurn_deg = 1.3;

/// Two slopes over a frame whose borders are at -1 and 1, v up the picture.
using Field = std::function<std::array<double, 2>(double u, double v)>;

/// 1.5 degrees a side and more in the corners.
std::array<double, 2> bowl(double u, double v) {
  const double d = radians(1.5);
  return {d * (0.8 * u + 0.3 * u * u * u + 0.2 * v * u * u), d * (0.7 * v + 0.25 * v * v * v - 0.2 * u * v)};
}

std::array<double, 2> at_pixel(const Field& field, Size size, int x, int y) {
  return field((2 * x + 1.0) / size.width - 1, 1 - (2 * y + 1.0) / size.height);
}

void add(const Field& field, TestSlopes& s) {
  for (int y = 0; y < s.right.height(); ++y) {
    for (int x = 0; x < s.right.width(); ++x) {
      const auto slope = at_pixel(field, s.right.size(), x, y);
      s.right(x, y) += static_cast<float>(slope[0]);
      s.up(x, y) += static_cast<float>(slope[1]);
    }
  }
}

/// Rms over the frame of what is removed less a field, in degrees.
double misses_deg(const SlowSlopes& slow, const Field& field) {
  const Image<float> removed = removed_slopes(slow);
  double sum = 0;
  for (int y = 0; y < removed.height(); ++y) {
    for (int x = 0; x < removed.width(); ++x) {
      const auto slope = at_pixel(field, removed.size(), x, y);
      sum += std::pow(removed(x, y, 0) - slope[0], 2) + std::pow(removed(x, y, 1) - slope[1], 2);
    }
  }
  return degrees(std::sqrt(sum / static_cast<double>(removed.size().pixels())));
}

const Field kNothing = [](double, double) { return std::array{0.0, 0.0}; };

Repeat repeat_off_by(double factor) {
  const double c = 2 * kPitch_px * factor * std::cos(radians(kTurn_deg));
  const double s = 2 * kPitch_px * factor * std::sin(radians(kTurn_deg));
  return {c, s, -s, c};
}

FlattenOptions over_repeats(double factor, int degree = 3) {
  return {.method = FlattenMethod::kRepeat, .degree = degree, .repeat = repeat_off_by(factor)};
}

SlowSlopes slow_of(const TestSlopes& s, FlattenOptions options, View<const std::uint16_t> status = {}) {
  options.mm_per_pixel = kMmPerPixel;
  Result<SlowSlopes> slow = slow_slopes(s.right.plane(), s.up.plane(), status, options);
  if (!slow) {
    ADD_FAILURE() << slow.error().message();
    return {};
  }
  return std::move(slow).value();
}

TestSlopes yarns_that_wander(Size size) {
  return weave_slopes(size, kPitch_px, {.turn_deg = kTurn_deg, .jitter = 0.04});
}

TEST(Flatten, TakesABowlOutToAFiftiethOfADegreeAndLeavesTheCloth) {
  for (const Size size : {Size{512, 512}, {900, 640}}) {
    TestSlopes s = yarns_that_wander(size);
    for (const double off : {1.0, 1.02}) {
      const SlowSlopes clean = slow_of(s, over_repeats(off));
      EXPECT_EQ(clean.method, FlattenMethod::kRepeat);
      EXPECT_LT(misses_deg(clean, kNothing), 0.02) << size.width << ", repeat times " << off;
    }
    EXPECT_LT(misses_deg(slow_of(s, {}), kNothing), 0.05) << "detail lost without a repeat";
    add(bowl, s);
    EXPECT_LT(misses_deg(slow_of(s, over_repeats(1)), bowl), 0.02) << size.width;
    const SlowSlopes hann = slow_of(s, {});
    EXPECT_EQ(hann.method, FlattenMethod::kHann);
    EXPECT_LT(misses_deg(hann, bowl), 0.05) << size.width;
  }
}

TEST(Flatten, TakesACornerErrorThatNoCubicHoldsByAQuinticOfRepeats) {
  const Field corner = [](double u, double v) {
    return std::array{radians(1.5) * std::pow(u, 7), radians(1.5) * std::pow(v, 7) * (0.5 + 0.5 * u)};
  };
  TestSlopes s = yarns_that_wander({900, 640});
  add(corner, s);
  const double cubic = misses_deg(slow_of(s, over_repeats(1)), corner);
  const double quintic = misses_deg(slow_of(s, over_repeats(1, 5)), corner);
  const double under_hann = misses_deg(slow_of(s, {.degree = 5}), corner);
  EXPECT_LT(cubic, 0.16);
  EXPECT_LT(quintic, 0.05);
  EXPECT_GT(under_hann, 1.3 * quintic) << "corners count for little under a Hann window";
}

TEST(Flatten, StatesTiltRangeAndBowOfWhatItRemoves) {
  // h = a (u^2 + v^2) / 2 in mm on a frame of 20 by 12 mm, tilted by 3 degrees: bow a, range to a corner.
  const Size size = {400, 240};
  const double to_u = 2 / (size.width * kMmPerPixel), to_v = 2 / (size.height * kMmPerPixel), a = 0.1;
  TestSlopes s = level_slopes(size);
  const double tilt = std::tan(radians(3.0));
  add([&](double u, double v) { return std::array{tilt + a * u * to_u, a * v * to_v}; }, s);
  const SlowSlopes slow = slow_of(s, {});
  EXPECT_NEAR(slow.tilt_deg, 3, 0.01);
  EXPECT_NEAR(slow.bow_mm, a, 0.02 * a);  // its corners are those of pixels
  EXPECT_NEAR(slow.range_deg, degrees(std::atan(std::hypot(a * to_u, a * to_v))), 0.02);
  EXPECT_TRUE(slow.acts);
  flatten(slow, {}, s.right.plane(), s.up.plane());
  for (int y = 0; y < size.height; y += 17) {
    for (int x = 0; x < size.width; x += 17) EXPECT_NEAR(std::hypot(s.right(x, y), s.up(x, y)), 0, 1e-5);
  }
}

TEST(Flatten, RemovesNothingThatIsWithinWhatIsKnown) {
  TestSlopes s = yarns_that_wander({512, 512});
  const Field slight = [](double u, double) { return std::array{radians(0.2) * u, 0.0}; };
  add(slight, s);
  const SlowSlopes kept = slow_of(s, {.sigma_deg = 0.4}), taken = slow_of(s, {.sigma_deg = 0.1});
  EXPECT_FALSE(kept.acts);
  EXPECT_NEAR(kept.range_deg, 0.2, 0.05) << "what was found is said all the same";
  EXPECT_EQ(misses_deg(kept, kNothing), 0);
  EXPECT_TRUE(taken.acts);
  EXPECT_LT(misses_deg(taken, slight), 0.03);
}

TEST(Flatten, KeepsFoldsOfManyRepeatsUnlessAskedByAHighPass) {
  const Size size = {1000, 600};  // 50 by 30 mm, a fold each 12 mm
  const Field folds = [&](double u, double) {
    return std::array{std::tan(radians(8.0)) * std::sin(2 * kPi * u * size.width * kMmPerPixel / 2 / 12),
                      0.0};
  };
  TestSlopes s = weave_slopes(size, kPitch_px);
  add(folds, s);
  const SlowSlopes polynomial = slow_of(s, {});
  EXPECT_LT(misses_deg(polynomial, kNothing), 0.05 * 8 / std::sqrt(2.0)) << "of the folds' rms";
  const SlowSlopes high_pass = slow_of(s, {.method = FlattenMethod::kHighPass, .cut_mm = 4});
  EXPECT_LT(misses_deg(high_pass, folds), 0.2 * 8 / std::sqrt(2.0)) << "of the folds' rms";
}

// A cubic that follows the middle of a fold of eight degrees swings out to 45 in the corners.
TEST(Flatten, TakesNoSteeperSlopesOffThanAFoldHas) {
  const Size size = {768, 512};
  for (const double phase : {0.0, 0.8, 1.6, 2.4}) {
    const Field fold = [&](double u, double v) {
      const double along_mm = (0.57 * u * size.width + 0.82 * v * size.height) * kMmPerPixel / 2;
      const double slope = 0.147 * std::cos(2 * kPi * along_mm / 30 + phase);
      return std::array{0.57 * slope, 0.82 * slope};
    };
    TestSlopes s = yarns_that_wander(size);
    add(fold, s);
    const SlowSlopes slow = slow_of(s, {});
    const Image<float> removed = removed_slopes(slow);
    float steepest = 0;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x)
        steepest = std::max(steepest, std::hypot(removed(x, y, 0), removed(x, y, 1)));
    }
    EXPECT_LE(steepest, 0.147F) << "degree " << slow.degree << ", phase " << phase;
  }
}

TEST(Flatten, HighPassHalvesTheWavelengthOfItsCut) {
  const Size size = {1200, 300};
  for (const double wavelength_mm : {3.0, 6.0}) {
    const double period_px = wavelength_mm / kMmPerPixel;
    TestSlopes s = level_slopes(size);
    add(
        [&](double u, double) {
          return std::array{0.1 * std::sin(kPi * u * size.width / period_px), 0.0};
        },
        s);
    const Image<float> removed =
        removed_slopes(slow_of(s, {.method = FlattenMethod::kHighPass, .cut_mm = wavelength_mm}));
    double most = 0;
    for (int x = 300; x < 900; ++x) most = std::max(most, double{removed(x, 150, 0)});
    EXPECT_NEAR(most / 0.1, 0.5, 0.01) << wavelength_mm;
  }
}

TEST(Flatten, TakesHannWhereTheFrameHoldsTooFewRepeatsAndSaysSo) {
  TestSlopes s = yarns_that_wander({100, 100});
  add(bowl, s);
  const SlowSlopes slow = slow_of(s, over_repeats(1));
  EXPECT_EQ(slow.method, FlattenMethod::kHann);
  EXPECT_TRUE(slow.lacks_repeats);
}

TEST(Flatten, LeavesOutWhatHasNoSlope) {
  TestSlopes s = yarns_that_wander({512, 512});
  add(bowl, s);
  Image<std::uint16_t> status(s.right.size());
  for (int y = 200; y < 260; ++y) {
    for (int x = 80; x < 160; ++x) {
      status(x, y) = kNoSolution;
      s.right(x, y) = s.up(x, y) = 0;
    }
  }
  s.right(400, 400) = std::numeric_limits<float>::quiet_NaN();
  const SlowSlopes slow = slow_of(s, {}, status.plane());
  EXPECT_LT(misses_deg(slow, bowl), 0.1);
  flatten(slow, status.plane(), s.right.plane(), s.up.plane());
  EXPECT_EQ(s.right(100, 220), 0) << "pixels without a normal stay level";
}

TEST(Flatten, HasTheSameBytesOnAnyNumberOfThreads) {
  TestSlopes s = yarns_that_wander({300, 280});
  add(bowl, s);
  for (const FlattenMethod method :
       {FlattenMethod::kHann, FlattenMethod::kRepeat, FlattenMethod::kHighPass}) {
    const FlattenOptions one = {.method = method, .repeat = repeat_off_by(1), .cut_mm = 3, .threads = 1};
    FlattenOptions many = one;
    many.threads = 7;
    EXPECT_TRUE(same_floats(removed_slopes(slow_of(s, one), 1), removed_slopes(slow_of(s, many), 7)));
  }
}

TEST(Flatten, RefusesWhatCannotBeMeant) {
  const TestSlopes s = weave_slopes({64, 64}, 10), other = level_slopes({10, 10});
  const auto is_done = [&](const FlattenOptions& options) {
    return slow_slopes(s.right.plane(), s.up.plane(), {}, options).has_value();
  };
  EXPECT_TRUE(is_done({.mm_per_pixel = 1}));
  EXPECT_FALSE(is_done({}));
  EXPECT_FALSE(is_done({.degree = 6, .mm_per_pixel = 1}));
  EXPECT_FALSE(is_done({.method = FlattenMethod::kHighPass, .mm_per_pixel = 1}));
  EXPECT_FALSE(is_done({.method = FlattenMethod::kRepeat, .mm_per_pixel = 1}));
  EXPECT_FALSE(slow_slopes(s.right.plane(), other.up.plane(), {}, {.mm_per_pixel = 1}));
  Image<std::uint16_t> status(s.right.size());
  for (int y = 0; y < 64; ++y) std::fill_n(status.plane().row(y), 64, std::uint16_t{kNoSolution});
  EXPECT_FALSE(slow_slopes(s.right.plane(), s.up.plane(), status.plane(), {.mm_per_pixel = 1}));
}

}  // namespace
}  // namespace weft::material
