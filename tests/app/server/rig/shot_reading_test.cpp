// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/shot_reading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace weft::app {
namespace {

constexpr double kShotBlack = 600, kShotWhite = 15600;

/// A frame of one brightness, a share of the way from black to white, where it is known to be full.
RawFrame even_frame(double share) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>(Size{96, 72});
  const auto counts = static_cast<std::uint16_t>(std::lround(kShotBlack + share * (kShotWhite - kShotBlack)));
  for (int y = 0; y < 72; ++y) {
    for (int x = 0; x < 96; ++x) frame.counts(x, y) = counts;
  }
  frame.black = {{{kShotBlack, kShotBlack}, {kShotBlack, kShotBlack}}};
  frame.white = kShotWhite;
  frame.full.fill(kShotWhite);
  return frame;
}

/// A rig of three LEDs above a cloth that comes to half of the range in 2000 us, and nothing is calibrated.
struct ReadRig {
  ReadRig() { rig.leds = 3; }

  ShotReading read(double share, int led, double exposure_us) {
    return reader.read(even_frame(share), led, exposure_us, {500, 1000, 2000, 4000, 8000},
                       [this](int, double us) -> Result<capture::Brightness> {
                         ++metered;
                         if (fails) return Error{ErrorKind::kTryAgain, "", "", "", ""};
                         const double bright = std::min(1.0, 0.5 * us / 2000);
                         return capture::Brightness{bright, bright, bright < 1 ? 0.0 : 1.0};
                       });
  }

  capture::Rig rig;
  ShotReader reader{rig};
  int metered = 0;  ///< shots of the meter's own
  bool fails = false;
};

TEST(ShotReader, SuggestsWhatAReadableShotSays) {
  ReadRig rig;
  const ShotReading reading = rig.read(0.4, 1, 1000);
  EXPECT_EQ(reading.size, (Size{96, 72}));
  EXPECT_EQ(reading.suggested_us.value_or(0), 2000);
  EXPECT_EQ(rig.metered, 0);
}

TEST(ShotReader, MetersOnceInASeriesOfLikeShots) {
  ReadRig rig;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(rig.read(1, 1, 8000).suggested_us.value_or(0), 2000);
  const int once = rig.metered;
  EXPECT_GE(once, rig.rig.leds);
  EXPECT_EQ(rig.read(0.01, 1, 8000).suggested_us.value_or(0), 2000) << "of another cloth";
  const int twice = rig.metered;
  EXPECT_GT(twice, once);
  EXPECT_EQ(rig.read(0.01, 2, 8000).suggested_us.value_or(0), 2000) << "by another LED";
  EXPECT_GT(rig.metered, twice);
}

TEST(ShotReader, SuggestsNothingInTheDarkAndWhereTheMeterFails) {
  ReadRig rig;
  EXPECT_FALSE(rig.read(0.4, 0, 1000).suggested_us);
  rig.fails = true;
  EXPECT_FALSE(rig.read(1, 1, 1000).suggested_us);
  EXPECT_EQ(rig.metered, 1);
  rig.fails = false;
  EXPECT_TRUE(rig.read(1, 1, 1000).suggested_us) << "a meter that failed is not remembered";
}

TEST(ShotReader, BeginsASeriesWithAnotherLedOrExposure) {
  ReadRig rig;
  EXPECT_EQ(rig.read(0.4, 1, 1000).focus.scores.size(), 1u);
  EXPECT_EQ(rig.read(0.4, 1, 1000).focus.scores.size(), 2u);
  rig.reader.calibrate({});
  EXPECT_EQ(rig.read(0.4, 1, 1000).focus.scores.size(), 3u);
  EXPECT_EQ(rig.read(0.4, 2, 1000).focus.scores.size(), 1u);
  EXPECT_EQ(rig.read(0.4, 2, 2000).focus.scores.size(), 1u);
  EXPECT_EQ(rig.read(0.4, 2, 2000).focus.scores.size(), 2u);
}

}  // namespace
}  // namespace weft::app
