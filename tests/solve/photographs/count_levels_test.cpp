// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/count_levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace weft::solve {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Three lit frames and a dark one of a sensor whose black is 600 and that stops at 15520, times `scale`, less
// `offset`, in files that call `black` and `white` so.
std::vector<RawFrame> session(float black, float white, double scale = 1, double offset = 0,
                              double light = 1) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<RawFrame> frames(4);
  for (std::size_t k = 0; k < 4; ++k) {
    frames[k].counts = Image<std::uint16_t>({128, 96});
    frames[k].black = {{{black, black}, {black, black}}};
    frames[k].white = white;
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 128; ++x) {
        const double signal = k == 3 ? 0 : light * 8000 * (1 + 0.5 * std::sin(0.3 * x) * std::cos(0.2 * y));
        const double counts = std::min(600 + signal + std::sqrt(signal / 2.5 + 4) * normal(random), 15520.0);
        frames[k].counts(x, y) =
            static_cast<std::uint16_t>(std::lround(std::clamp(scale * counts - offset, 0.0, 65535.0)));
      }
  }
  return frames;
}

std::optional<Response> calibrated(std::vector<double> full_rgb = {}) {
  Response response;
  response.levels = {{600, 600, 600, 600}, 15520, {600, 600, 600}, std::move(full_rgb)};
  return response;
}

struct Settled {
  double black = 0, white = 0;
  std::array<float, 3> full = {};
  std::vector<std::string> said;
  double scale = 1;
};

Settled settle(std::vector<RawFrame> frames, const std::optional<Response>& response, bool has_dark = true) {
  if (!has_dark) frames.pop_back();
  auto settled = settle_levels(frames, 3, has_dark, response, 1);
  EXPECT_TRUE(settled.has_value()) << settled.error().message();
  if (!settled) return {};
  const RawFrame& frame = frames.front();
  return {static_cast<double>(frame.black[1][0]), static_cast<double>(frame.white), frame.full, settled->said,
          settled->scale};
}

constexpr std::array<float, 3> kAsSaid = {};

TEST(SettleLevels, LeavesFilesThatSayWhatTheCalibrationsSaid) {
  for (const auto& response : {calibrated(), std::optional<Response>()}) {
    const Settled settled = settle(session(600, 15520), response);
    EXPECT_EQ(settled.black, 600);
    EXPECT_EQ(settled.white, 15520);
    EXPECT_EQ(settled.full, kAsSaid);
    EXPECT_THAT(settled.said, IsEmpty());
  }
}

TEST(SettleLevels, TakesTheCalibrationsLevelsWhereTheDarkShotShowsTheSameCounts) {
  for (const auto& [black, white] : {std::pair{0.0F, 15520.0F},
                                     {1000.0F, 15520.0F},
                                     {600.0F, 4095.0F},
                                     {600.0F, 16383.0F},
                                     {0.0F, 65535.0F}}) {
    const Settled settled = settle(session(black, white), calibrated());
    EXPECT_NEAR(settled.black, 600, 1) << "the file says " << black;
    EXPECT_NEAR(settled.white, 15520, 1) << "the file says " << white;
    EXPECT_THAT(settled.said, ElementsAre(HasSubstr("are taken")));
  }
}

TEST(SettleLevels, TakesCountsThatWereShiftedByTwoBits) {
  const Settled settled = settle(session(2400, 65535, 4), calibrated());
  EXPECT_NEAR(settled.black, 2400, 3);
  EXPECT_NEAR(settled.white, 62080, 10) << "4 times 15520";
  EXPECT_EQ(settled.scale, 4);
  EXPECT_EQ(scaled({.electrons_per_count = 2.5, .read_noise_counts = 2}, 4).electrons_per_count, 0.625);
  EXPECT_EQ(scaled({.electrons_per_count = 2.5, .read_noise_counts = 2}, 4).read_noise_counts, 8);
  EXPECT_THAT(settle(session(2400, 62080, 4), calibrated()).said, IsEmpty()) << "as the file says itself";
}

TEST(SettleLevels, LeavesFilesWhoseBlackAConverterTookAway) {
  const Settled settled = settle(session(0, 14920, 1, 600), calibrated());
  EXPECT_EQ(settled.white, 14920);
  EXPECT_THAT(settled.said, IsEmpty());
}

TEST(SettleLevels, RefusesOtherLevelsWhereNothingTellsWhatTheyMean) {
  std::vector<RawFrame> frames = session(0, 15520);
  frames.pop_back();
  const auto refused = settle_levels(frames, 3, false, calibrated(), 1);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message(), HasSubstr("0 black and 15520 white"));
}

TEST(SettleLevels, TakesTheDarkShotForBlackWhereTheCalibrationDoesNotSayItsOwn) {
  const Settled settled = settle(session(1000, 15520), {});
  EXPECT_NEAR(settled.black, 600, 1);
  EXPECT_THAT(settled.said, ElementsAre(HasSubstr("the dark shot reads 600")));
}

TEST(SettleLevels, DoesNotTakeALitDarkShotForBlack) {
  std::vector<RawFrame> frames = session(600, 15520);
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 128; ++x)
      frames[3].counts(x, y) = static_cast<std::uint16_t>(frames[0].counts(x, y) / 4 + 450);
  EXPECT_EQ(settle(std::move(frames), {}).black, 600);
}

TEST(SettleLevels, FindsWhereCountsStopBelowTheFilesWhite) {
  const Settled settled = settle(session(600, 16383, 1, 0, 1.5), {});
  EXPECT_EQ(settled.full, (std::array<float, 3>{15520, 15520, 15520}));
  EXPECT_THAT(settled.said, ElementsAre(HasSubstr("green at 15520")));
  EXPECT_EQ(settle(session(600, 15520, 1, 0, 1.5), {}).full, kAsSaid) << "where the file says it itself";
}

TEST(SettleLevels, BelievesTheCalibrationWhereTheCameraStops) {
  const Settled settled = settle(session(600, 15520), calibrated({15400, 15300, 0}));
  EXPECT_EQ(settled.full, (std::array<float, 3>{15400, 15300, 0}));
  EXPECT_THAT(settled.said, IsEmpty());
}

TEST(SettleLevels, RefusesCountsFarAboveWhiteWithoutACalibrationThatSaysIts) {
  std::vector<RawFrame> frames = session(600, 4095);
  const auto refused = settle_levels(frames, 3, true, {}, 1);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message(), HasSubstr("far above 4095"));
}

}  // namespace
}  // namespace weft::solve
