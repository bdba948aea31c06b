// SPDX-License-Identifier: Apache-2.0
#include "core/rig/reading_stop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "core/rig/dark_counts.h"

namespace weft {
namespace {

using Light = std::function<double(int x, int y)>;

// Counts of a sensor of 2.5 electrons a count, black 600, that stop at `full`, scattered there over
// `scatter`.
RawFrame seen(const Light& light, int full, unsigned seed, int scatter = 0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  RawFrame frame;
  frame.counts = Image<std::uint16_t>({256, 192});
  frame.black = {{{600, 600}, {600, 600}}};
  frame.white = 16383;
  for (int y = 0; y < 192; ++y)
    for (int x = 0; x < 256; ++x) {
      const double counts = light(x, y);
      const double noisy = 600 + counts + std::sqrt(counts / 2.5 + 4) * normal(random);
      const int most = full + (scatter > 0 ? static_cast<int>(random() % static_cast<unsigned>(scatter)) : 0);
      frame.counts(x, y) =
          static_cast<std::uint16_t>(std::clamp(static_cast<int>(std::lround(noisy)), 0, most));
    }
  return frame;
}

std::array<float, 3> stops(const std::vector<RawFrame>& frames) {
  std::vector<std::array<TopTally, 3>> tallies;
  for (const RawFrame& frame : frames) tallies.push_back(top_tallies(frame));
  return find_count_stops(tallies, frames.front());
}

std::array<float, 3> stops(const Light& light, int full, int scatter = 0) {
  std::vector<RawFrame> frames;
  for (unsigned seed = 1; seed <= 3; ++seed) frames.push_back(seen(light, full, seed, scatter));
  return stops(frames);
}

double weave(int x, int y) {
  return 9000 * (1 + 0.5 * std::sin(0.3 * x) * std::cos(0.2 * y));
}

constexpr std::array<float, 3> kNowhere = {};

TEST(FindCountStops, FindsWhereEachChannelStops) {
  const std::array<float, 3> found = stops([](int x, int y) { return 1.3 * weave(x, y); }, 15520);
  EXPECT_EQ(found, (std::array<float, 3>{15520, 15520, 15520}));
}

TEST(FindCountStops, FindsGreenAloneWhereGreenAloneIsFull) {
  const CfaPattern cfa;
  const std::array<float, 3> found =
      stops([&](int x, int y) { return (cfa.channel_at(x, y) == 1 ? 1.3 : 0.5) * weave(x, y); }, 15520);
  EXPECT_EQ(found, (std::array<float, 3>{0, 15520, 0}));
}

TEST(FindCountStops, FindsFramesThatAreFullNearlyEverywhere) {
  const std::array<float, 3> found = stops([](int x, int y) { return 4 * weave(x, y); }, 15520);
  EXPECT_EQ(found, (std::array<float, 3>{15520, 15520, 15520}));
}

TEST(FindCountStops, FindsAnEndThatScattersOverSomeCounts) {
  for (const float stop : stops([](int x, int y) { return 1.3 * weave(x, y); }, 15520, 30)) {
    EXPECT_GE(stop, 15515) << "from 15520 to 15549";
    EXPECT_LE(stop, 15530);
  }
}

TEST(FindCountStops, FindsNoneInClothThatIsNotFull) {
  EXPECT_EQ(stops(weave, 16383), kNowhere);
}

TEST(FindCountStops, FindsNoneInSmoothPaperOrInItsBrightestPatch) {
  for (const double counts : {2000.0, 9000.0, 14000.0})
    EXPECT_EQ(stops([&](int, int) { return counts; }, 16383), kNowhere) << "paper at " << counts;
  EXPECT_EQ(stops([](int x, int) { return x < 64 ? 14000.0 : 3000.0; }, 16383), kNowhere);
}

TEST(FindCountStops, FindsNoneInAHighlightOrAtHotPhotosites) {
  const auto highlight = [](int x, int y) {
    return 3000 + 11000 * std::exp(-(std::pow(x - 128, 2) + std::pow(y - 96, 2)) / 2000.0);
  };
  EXPECT_EQ(stops(highlight, 16383), kNowhere);
  std::vector<RawFrame> frames;
  for (unsigned seed = 1; seed <= 2; ++seed) {
    frames.push_back(seen(weave, 16383, seed));
    for (int i = 0; i < 12; ++i) frames.back().counts(20 * i, 15 * i) = 16000;
  }
  EXPECT_EQ(stops(frames), kNowhere) << "12 photosites are no pile";
}

TEST(FindCountStops, FindsInOneFrameWhereOneCountPilesUpBelowWhite) {
  const auto of_one = [](const Light& light, int full, int scatter = 0) {
    return find_count_stops(seen(light, full, 1, scatter));
  };
  for (const double times : {1.3, 4.0})
    EXPECT_EQ(of_one([&](int x, int y) { return times * weave(x, y); }, 15520),
              (std::array<float, 3>{15520, 15520, 15520}));
  EXPECT_EQ(of_one([](int x, int y) { return 4 * weave(x, y); }, 16383), kNowhere) << "at white";
  EXPECT_EQ(of_one(weave, 16383), kNowhere);
  for (const double counts : {2000.0, 9000.0, 14000.0})
    EXPECT_EQ(of_one([&](int, int) { return counts; }, 16383), kNowhere) << "paper at " << counts;
}

TEST(FindCountStops, FindsThePileBelowHotPhotosites) {
  std::vector<RawFrame> frames;
  for (unsigned k = 0; k < 3; ++k) {
    frames.push_back(seen([](int x, int y) { return 1.3 * weave(x, y); }, 15520, k));
    frames.back().counts(10, 10) = 16383;
  }
  EXPECT_EQ(stops(frames)[0], 15520);
}

TEST(DarkCounts, AreTheMedianOfEachChannelWhateverIsHot) {
  RawFrame dark = seen([](int, int) { return 0.0; }, 16383, 1);
  for (int i = 0; i < 100; ++i) dark.counts(2 * i, i) = 15000;
  for (const double median : dark_counts(dark).median) EXPECT_NEAR(median, 600, 1);
  EXPECT_NEAR(dark_counts(dark).spread, 2 * 1.645 * 2, 1)
      << "nine tenths of a normal distribution of sigma 2";
}

}  // namespace
}  // namespace weft
