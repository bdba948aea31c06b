// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/histogram.h"

#include <gtest/gtest.h>

#include <numeric>

namespace weft::capture {
namespace {

constexpr float kBlack = 600, kWhite = 15520;

/// Red at a quarter of the range, green at half, blue at three quarters; known to be full at white.
RawFrame three_levels(Size size) {
  RawFrame frame = {Image<std::uint16_t>(size), {}, {{{kBlack, kBlack}, {kBlack, kBlack}}}, kWhite, {}};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const float share = 0.25f * static_cast<float>(1 + frame.cfa.channel_at(x, y));
      frame.counts(x, y) = static_cast<std::uint16_t>(kBlack + share * (kWhite - kBlack) + 1);
    }
  }
  frame.full = {kWhite, kWhite, kWhite};
  return frame;
}

TEST(Histogram, CountsEachChannelFromBlackToWhite) {
  const auto histograms = histogram_rgb(three_levels({40, 30}));
  EXPECT_EQ(histograms[0].bins[16], 300u);
  EXPECT_EQ(histograms[1].bins[32], 600u);
  EXPECT_EQ(histograms[2].bins[48], 300u);
  for (const RawHistogram& histogram : histograms) {
    EXPECT_EQ(histogram.clipped, 0);
  }
}

TEST(Histogram, PutsWhatIsBelowBlackInTheFirstBinAndWhatIsFullInTheLast) {
  RawFrame frame = three_levels({40, 30});
  frame.counts(0, 0) = 0;
  frame.counts(2, 0) = 15520;
  frame.counts(4, 0) = 16383;
  const RawHistogram red = histogram_rgb(frame)[0];
  EXPECT_EQ(red.bins[0], 1u);
  EXPECT_EQ(red.bins[63], 2u);
  EXPECT_DOUBLE_EQ(red.clipped, 2.0 / 300);
  EXPECT_EQ(std::accumulate(red.bins.begin(), red.bins.end(), 0u), 300u);
}

TEST(Brightness, IsThatOfTheBrightestChannel) {
  const Brightness brightness = brightness_of(three_levels({40, 30}));
  EXPECT_NEAR(brightness.bright, 0.75, 1e-3);
  EXPECT_EQ(brightness.clipped, 0);
}

TEST(Brightness, DoesNotCountHotPhotosites) {
  RawFrame frame = three_levels({40, 30});
  frame.counts(11, 11) = 16383;
  frame.counts(20, 20) = 16383;
  EXPECT_NEAR(brightness_of(frame).brightest, 0.75, 1e-3);
  EXPECT_EQ(brightness_of(frame).clipped, 0);
}

TEST(Brightness, CountsAHighlight) {
  RawFrame frame = three_levels({40, 30});
  for (int y = 10; y < 16; ++y) {
    for (int x = 10; x < 16; ++x) frame.counts(x, y) = 16383;
  }
  EXPECT_GE(brightness_of(frame).brightest, 1);
  EXPECT_NEAR(brightness_of(frame).clipped, 9.0 / 300, 1e-9);
}

}  // namespace
}  // namespace weft::capture
