// SPDX-License-Identifier: Apache-2.0
#include "core/rig/radiometry.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/simd_targets.h"

namespace weft {
namespace {

using test::on_every_target;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A frame with a black level of its own for each site and counts from below black to full.
RawFrame frame_of(Size size) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>(size);
  frame.black = {{{600, 610}, {590, 605}}};
  frame.white = 15800;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      frame.counts(x, y) = static_cast<std::uint16_t>(500 + (x * 263 + y * 7919) % 15400);
    }
  }
  return frame;
}

RawFrame dark_of(Size size) {
  RawFrame dark = frame_of(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x)
      dark.counts(x, y) = static_cast<std::uint16_t>(580 + (x * 31 + y * 17) % 50);
  }
  return dark;
}

// The formula at the head of core/rig/radiometry.h, a site at a time.
double reading_at(const RawFrame& frame, const RawFrame* dark, const Response& response,
                  Radiometry::Exposure exposure, int x, int y) {
  const double black =
      static_cast<double>(frame.black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)]);
  const double range = static_cast<double>(frame.white) - black, count = frame.counts(x, y);
  if (count >= black + kSaturatedFrom * range) return kInfinity;
  const double v = (count - (dark != nullptr ? dark->counts(x, y) : black)) / range;
  const auto& [a, b] = response.linearity[static_cast<std::size_t>(frame.cfa.channel_at(x, y))];
  return v * (1 + a * v + b * v * v) / (exposure.exposure_us * 1e-6 * exposure.iso / 100);
}

Image<float> readings_of(const Radiometry& radiometry, const RawFrame& frame, Rect tile) {
  Image<float> out({tile.width(), tile.height()});
  radiometry.read(frame.counts.plane(), tile, out.plane());
  return out;
}

// One site at a time: black 1000, white 11000, half a second at ISO 400, so that a count is 1e-4 / 2.
struct OneSite {
  RawFrame frame, dark;
  Response response;
  bool with_dark = false;

  double reading(std::uint16_t count) {
    frame.counts = Image<std::uint16_t>({2, 2});
    frame.black = {{{1000, 1000}, {1000, 1000}}};
    frame.white = 11000;
    frame.counts(0, 0) = count;
    const Radiometry radiometry(frame, with_dark ? &dark : nullptr, response, {5e5, 400});
    return static_cast<double>(readings_of(radiometry, frame, {0, 0, 1, 1})(0, 0));
  }
};

TEST(Radiometry, TurnsACountIntoLightASecondAtIso100) {
  OneSite site;
  EXPECT_NEAR(site.reading(6000), 0.25, 1e-7);
  EXPECT_EQ(site.reading(1000), 0);
  EXPECT_NEAR(site.reading(900), -0.005, 1e-8) << "noise below black stays, for its mean is zero";
}

TEST(Radiometry, IsSaturatedFromNinetyEightHundredths) {
  OneSite site;
  EXPECT_NEAR(site.reading(10799), 0.5 * 0.9799, 1e-7);
  EXPECT_EQ(site.reading(10800), kInfinity);
  EXPECT_EQ(site.reading(65535), kInfinity);
  site.dark.counts = Image<std::uint16_t>({2, 2});
  site.dark.counts(0, 0) = 10900;
  site.with_dark = true;
  EXPECT_EQ(site.reading(10900), kInfinity) << "a hot photosite, however dark the difference";
}

TEST(Radiometry, AppliesTheLinearityOfTheChannel) {
  OneSite site;
  site.response.linearity[0] = {0.2, -0.1};
  EXPECT_NEAR(site.reading(6000), 2 * 0.25 * 0.5 * (1 + 0.2 * 0.5 - 0.1 * 0.25), 1e-7);
  site.response.linearity = {{{0, 0}, {0.2, -0.1}, {0.2, -0.1}}};
  EXPECT_NEAR(site.reading(6000), 0.25, 1e-7) << "the site is red";
}

TEST(Radiometry, SubtractsTheDarkShotSiteBySite) {
  const Size size = {6, 4};
  const RawFrame frame = frame_of(size);
  RawFrame dark = dark_of(size);
  const Image<float> before =
      readings_of(Radiometry(frame, &dark, {}, {1e6, 100}), frame, {0, 0, size.width, size.height});
  dark.counts(2, 2) = static_cast<std::uint16_t>(dark.counts(2, 2) + 1000);
  const Image<float> after =
      readings_of(Radiometry(frame, &dark, {}, {1e6, 100}), frame, {0, 0, size.width, size.height});
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double change = static_cast<double>(after(x, y)) - static_cast<double>(before(x, y));
      if (std::isinf(before(x, y))) continue;
      EXPECT_NEAR(change, x == 2 && y == 2 ? -1000.0 / (15800 - 600) : 0, 1e-7)
          << "at (" << x << ", " << y << ")";
    }
  }
}

TEST(Radiometry, HasABlackLevelForEverySiteOfTheCell) {
  RawFrame frame = frame_of({8, 4});
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      frame.counts(x, y) = static_cast<std::uint16_t>(
          frame.black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)]);
    }
  }
  const Image<float> dark = readings_of(Radiometry(frame, nullptr, {}, {1e6, 100}), frame, {0, 0, 8, 4});
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) EXPECT_EQ(dark(x, y), 0.0F) << "at (" << x << ", " << y << ")";
  }
}

TEST(Radiometry, UsesTheMeasuredBlackLevelWhereThereIsNoDarkShot) {
  RawFrame frame = frame_of({8, 4});
  frame.counts(0, 0) = 612;  // the file's level there is 600, the cell's mean 601.25
  Response response;
  response.black_counts = 601.25 + 12;
  const Rect all = {0, 0, 8, 4};
  EXPECT_EQ(readings_of(Radiometry(frame, nullptr, response, {1e6, 100}), frame, all)(0, 0), 0.0F);
  EXPECT_NEAR(readings_of(Radiometry(frame, nullptr, {}, {1e6, 100}), frame, all)(0, 0), 12.0 / 15200, 1e-9);
  const RawFrame dark = dark_of({8, 4});
  const float with_dark = readings_of(Radiometry(frame, &dark, {}, {1e6, 100}), frame, all)(0, 0);
  EXPECT_EQ(readings_of(Radiometry(frame, &dark, response, {1e6, 100}), frame, all)(0, 0), with_dark);
}

TEST(Radiometry, IsTheScalarFormulaOnEveryTargetAtAnyWidth) {
  const Size size = {197, 6};
  const RawFrame dark = dark_of(size);
  Response response;
  response.linearity = {{{0.02, -0.015}, {0.03, 0.01}, {-0.01, 0.02}}};
  const Radiometry::Exposure exposure = {16364, 200};
  for (const CfaPattern& cfa :
       {CfaPattern{{{{0, 1}, {3, 2}}}}, CfaPattern{{{{2, 3}, {1, 0}}}}, CfaPattern{{{{1, 0}, {2, 3}}}}}) {
    RawFrame frame = frame_of(size);
    frame.cfa = cfa;
    on_every_target([&] {
      for (const RawFrame* subtracted : {static_cast<const RawFrame*>(nullptr), &dark}) {
        const Radiometry radiometry(frame, subtracted, response, exposure);
        EXPECT_EQ(radiometry.cfa(), cfa);
        for (const Rect tile : {Rect{0, 0, 1, 1}, Rect{0, 0, 197, 6}, Rect{64, 1, 197, 5}, Rect{2, 3, 9, 4},
                                Rect{128, 2, 161, 6}, Rect{190, 5, 197, 6}}) {
          const Image<float> readings = readings_of(radiometry, frame, tile);
          for (int y = 0; y < tile.height(); ++y) {
            for (int x = 0; x < tile.width(); ++x) {
              const double expected =
                  reading_at(frame, subtracted, response, exposure, tile.x0 + x, tile.y0 + y);
              const double got = static_cast<double>(readings(x, y));
              if (std::isinf(expected)) {
                ASSERT_EQ(got, expected) << "at (" << tile.x0 + x << ", " << tile.y0 + y << ")";
              } else {
                ASSERT_NEAR(got, expected, 3e-7 * std::abs(expected) + 1e-9)
                    << "at (" << tile.x0 + x << ", " << tile.y0 + y << ")";
              }
            }
          }
        }
      }
    });
  }
}

TEST(Radiometry, GivesTheSameBytesWhateverTheTile) {
  const Size size = {197, 6};
  const RawFrame frame = frame_of(size);
  Response response;
  response.linearity = {{{0.02, -0.015}, {0.03, 0.01}, {-0.01, 0.02}}};
  const Radiometry radiometry(frame, nullptr, response, {16364, 200});
  on_every_target([&] {
    const Image<float> whole = readings_of(radiometry, frame, {0, 0, size.width, size.height});
    for (int x0 = 0; x0 < size.width; x0 += 14) {
      const Rect tile = {x0, 1, std::min(x0 + 14, size.width), 4};
      const Image<float> part = readings_of(radiometry, frame, tile);
      for (int y = 0; y < tile.height(); ++y) {
        for (int x = 0; x < tile.width(); ++x) {
          ASSERT_EQ(std::bit_cast<std::uint32_t>(part(x, y)),
                    std::bit_cast<std::uint32_t>(whole(x0 + x, 1 + y)))
              << "at (" << x0 + x << ", " << 1 + y << ")";
        }
      }
    }
  });
}

// 2 electrons a count and 3 counts of read noise at 10000 counts from black to white, half a second at ISO
// 400: a reading of 1 is 20000 counts or 40000 electrons.
TEST(Radiometry, KnowsTheNoiseOfAReading) {
  RawFrame frame = frame_of({2, 2});
  frame.black = {{{1000, 1000}, {1000, 1000}}};
  frame.white = 11000;
  const Response response = {2, 3, {}};
  const NoiseModel alone = Radiometry(frame, nullptr, response, {5e5, 400}).noise();
  EXPECT_NEAR(alone.per_reading, 1.0 / 40000, 1e-11);
  EXPECT_NEAR(alone.floor, 9.0 / (20000.0 * 20000), 1e-14);
  EXPECT_EQ(alone.shared, 0) << "the black level has no noise";
  EXPECT_NEAR(alone.variance(0.25), 0.25 / 40000 + 9.0 / 4e8, 1e-11);
  EXPECT_EQ(alone.variance(-0.25), alone.floor);
  const NoiseModel with_dark = Radiometry(frame, &frame, response, {5e5, 400}).noise();
  EXPECT_EQ(with_dark.per_reading, alone.per_reading);
  EXPECT_EQ(with_dark.floor, alone.floor);
  EXPECT_EQ(with_dark.shared, alone.floor) << "the dark shot has the read noise of any other";
}

TEST(MergedExposures, AreWeightedByTheInverseOfTheirVariance) {
  constexpr float kFull = std::numeric_limits<float>::infinity();
  const float missing = std::numeric_limits<float>::quiet_NaN();
  const NoiseModel one = {1e-4, 0, 0}, four = {2.5e-5, 0, 0};  // four times the exposure
  struct Case {
    float shorter, longer, expected;
  };
  const std::vector<Case> cases = {
      {1, 1.1f, (1 + 4 * 1.1f) / 5}, {2, kFull, 2},           {missing, 3, 3},
      {kFull, kFull, kFull},         {missing, kFull, kFull}, {-0.1f, 0.1f, 0.06f}};
  const NoiseModel still_one = {1e-4, 1e-6, 0}, still_four = {2.5e-5, 2.5e-7, 0};
  Image<float> shorter({6, 1}), longer({6, 1}), out({6, 1});
  for (int x = 0; x < 6; ++x) {
    shorter(x, 0) = cases[static_cast<std::size_t>(x)].shorter;
    longer(x, 0) = cases[static_cast<std::size_t>(x)].longer;
  }
  const std::array<View<const float>, 2> readings = {shorter.plane(), longer.plane()};
  merge_exposures(readings, std::array{still_one, still_four}, out.plane());
  for (int x = 0; x < 6; ++x) {
    EXPECT_FLOAT_EQ(out(x, 0), cases[static_cast<std::size_t>(x)].expected) << "case " << x;
  }
  merge_exposures(readings, std::array{one, four}, out.plane());
  EXPECT_FLOAT_EQ(out(0, 0), (1 + 4 * 1.1f) / 5);
  longer(0, 0) = shorter(0, 0) = missing;
  merge_exposures(readings, std::array{one, four}, out.plane());
  EXPECT_TRUE(std::isnan(out(0, 0)));
}

TEST(MergedExposures, FavourNoReadingThatCameOutLow) {
  // 200000 pairs of 20 and 80 electrons: weights from each reading itself would be 1 percent low.
  std::mt19937 generator(3);
  std::poisson_distribution<int> short_one(20), long_one(80);
  constexpr int kCount = 200000;
  Image<float> shorter({kCount, 1}), longer({kCount, 1}), out({kCount, 1});
  for (int x = 0; x < kCount; ++x) {
    shorter(x, 0) = static_cast<float>(short_one(generator));
    longer(x, 0) = static_cast<float>(long_one(generator)) / 4;
  }
  const std::array<View<const float>, 2> readings = {shorter.plane(), longer.plane()};
  merge_exposures(readings, std::array<NoiseModel, 2>{{{1, 9, 0}, {0.25, 9.0 / 16, 0}}}, out.plane());
  double mean = 0;
  for (int x = 0; x < kCount; ++x) mean += static_cast<double>(out(x, 0)) / kCount;
  EXPECT_NEAR(mean, 20, 0.02);  // standard error 0.0045
}

}  // namespace
}  // namespace weft
