// SPDX-License-Identifier: Apache-2.0
#include "capture/framing/focus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace weft::capture {
namespace {

constexpr double kBlack = 600, kWhite = 16000;
constexpr PhotositeNoise kNoise = {4, 3};

/// A frame whose light (1 is full scale) follows `light`, with noise where a seed is given.
RawFrame frame_of(const std::function<double(int x, int y)>& light, unsigned seed = 0) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>(Size{480, 360});
  frame.black = {{{kBlack, kBlack}, {kBlack, kBlack}}};
  frame.white = kWhite;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int y = 0; y < 360; ++y) {
    for (int x = 0; x < 480; ++x) {
      const double counts = light(x, y) * (kWhite - kBlack);
      const double sigma = std::sqrt(counts / kNoise.electrons_per_count +
                                     kNoise.read_noise_counts * kNoise.read_noise_counts);
      const double noise = seed > 0 ? sigma * normal(random) : 0;
      frame.counts.plane()(x, y) = static_cast<std::uint16_t>(std::lround(kBlack + counts + noise));
    }
  }
  return frame;
}

double waves(double mean, double amplitude, double k, int x) {
  return mean * (1 + amplitude * std::cos(k * x));
}

TEST(Focus, OfWavesIsThatOfTheOperatorsResponse) {
  for (const double k : {0.2, 0.5, 1.0}) {
    const FocusMap map = focus_of(frame_of([&](int x, int) { return waves(0.4, 0.3, k, x); }), {});
    const double response = (2 * std::sin(k) + std::sin(2 * k)) / 4;
    EXPECT_NEAR(map.score / (0.09 * response * response), 1, 0.01) << "k " << k;
  }
}

TEST(Focus, OfNoiseAloneIsNothing) {
  const FocusMap with = focus_of(frame_of([](int, int) { return 0.02; }, 7), kNoise);
  const FocusMap without = focus_of(frame_of([](int, int) { return 0.02; }, 7), {});
  EXPECT_LT(with.score, 0.03 * without.score) << "what noise adds is taken off";
}

TEST(Focus, DoesNotFollowTheLight) {
  const auto score = [](double mean) {
    return focus_of(frame_of([&](int x, int) { return waves(mean, 0.2, 0.5, x); }, 3), kNoise).score;
  };
  EXPECT_NEAR(score(0.1) / score(0.4), 1, 0.02) << "a quarter of the light";
}

TEST(Focus, TakesNoHeedOfGreensThatDiffer) {
  RawFrame frame = frame_of([](int, int) { return 0.3; });
  for (int y = 0; y < 360; y += 2) {
    for (int x = 1; x < 480; x += 2) frame.counts.plane()(x, y) += 100;
  }
  EXPECT_LT(focus_of(frame, {}).score, 1e-9);
}

TEST(Focus, TellsNothingOfCellsThatAreDarkOrFull) {
  const FocusMap map = focus_of(
      frame_of([](int x, int y) { return x < 240   ? 0.0005
                                         : y < 180 ? 1.0
                                                   : waves(0.3, 0.2, 0.5, x); }), {});
  int told = 0;
  for (const double cell : map.cells) told += std::isfinite(cell) ? 1 : 0;
  EXPECT_EQ(told, 12) << "a quarter of 48";
  EXPECT_TRUE(std::isfinite(map.score));
  EXPECT_TRUE(std::isnan(focus_of(frame_of([](int, int) { return 0.0; }), {}).score));
  RawFrame tiny;
  tiny.counts = Image<std::uint16_t>(Size{2, 2});
  EXPECT_TRUE(std::isnan(focus_of(tiny, {}).score));
}

/// A camera whose sharp plane lies at `ring` in the middle of the frame and `tilt` further at its right edge.
FocusMap at(double ring, double tilt) {
  FocusMap map;
  double sum = 0;
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    const double x = 2.0 * static_cast<double>(i % FocusMap::kColumns) / (FocusMap::kColumns - 1) - 1;
    const double off = ring - tilt * x;
    const double texture = 1 + 0.5 * static_cast<double>(i % 3);  // cells differ, and that is no tilt
    map.cells[i] = texture * std::exp(-off * off);
    sum += map.cells[i];
  }
  map.score = sum / static_cast<double>(map.cells.size());
  return map;
}

TEST(FocusSeries, MarksTheSharpestAndForgetsTheOldest) {
  FocusSeries series;
  FocusStanding standing;
  for (int i = -10; i <= 10; ++i) standing = series.add(at(0.2 * i, 0));
  EXPECT_EQ(standing.scores.size(), 21u);
  EXPECT_EQ(standing.best, 10u);
  EXPECT_NEAR(standing.relative[0], std::exp(-4), 1e-12);
  for (int i = 0; i < 30; ++i) standing = series.add(at(2, 0));
  EXPECT_EQ(standing.scores.size(), FocusSeries::kKept);
  EXPECT_NEAR(standing.relative[0], 1, 1e-12) << "what was sharper is thirty photographs ago";
}

TEST(FocusSeries, TellsACameraThatLooksAskewByWhereEachEdgeIsSharpest) {
  FocusSeries straight, askew;
  FocusStanding a, b;
  for (int i = -10; i <= 10; ++i) {
    a = straight.add(at(0.1 * i, 0));
    b = askew.add(at(0.1 * i, 0.3));
    if (i == -9) {
      EXPECT_FALSE(a.more_right) << "two photographs tell nothing";
    }
  }
  EXPECT_NEAR(a.more_right.value_or(9), 0, 1e-9);
  EXPECT_NEAR(b.more_below.value_or(9), 0, 1e-9);
  // At the last photograph the ring stands 1 from the middle's best: exp(-(1 - 0.3)^2) to exp(-(1 + 0.3)^2).
  EXPECT_NEAR(b.more_right.value_or(0), std::exp(1.69 - 0.49) - 1, 0.05);
}

TEST(FocusSeries, OutlivesAPhotographThatTellsNothing) {
  FocusSeries series;
  FocusMap dark;
  dark.cells.fill(std::nan(""));
  dark.score = std::nan("");
  EXPECT_EQ(series.add(dark).best, 0u);
  EXPECT_EQ(series.add(at(0, 0)).best, 1u);
  const FocusStanding standing = series.add(dark);
  EXPECT_EQ(standing.best, 1u);
  EXPECT_FALSE(standing.more_right);
}

}  // namespace
}  // namespace weft::capture
