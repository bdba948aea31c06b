// SPDX-License-Identifier: Apache-2.0
#include "core/rig/photosites.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace weft {
namespace {

constexpr float kBlack = 600, kWhite = 15520;

// A frame of counts that rise over the frame and differ by filter, with read noise of 3 counts.
RawFrame frame_of(Size size, double level, unsigned seed) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>(size);
  frame.black = {{{kBlack, kBlack}, {kBlack, kBlack}}};
  frame.white = kWhite;
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double of_filter = 1 + 0.5 * frame.cfa.channel_at(x, y);
      const double light = level * of_filter * (1 + 0.5 * x / size.width);
      frame.counts(x, y) = static_cast<std::uint16_t>(std::lround(kBlack + light + noise(generator)));
    }
  }
  return frame;
}

std::vector<RawFrame> ten_lit(Size size) {
  std::vector<RawFrame> frames;
  for (unsigned k = 0; k < 10; ++k) frames.push_back(frame_of(size, k == 3 ? 0 : 300.0 + 100 * k, k));
  return frames;
}

const std::vector<Photosite> kPlaces = {{0, 0}, {0, 63}, {17, 31}, {30, 12}, {30, 14}, {47, 63}};

TEST(HotPhotosites, AreFoundAndNothingElseIs) {
  RawFrame dark = frame_of({64, 48}, 0, 1);
  for (const auto& [y, x] : kPlaces) dark.counts(x, y) = static_cast<std::uint16_t>(dark.counts(x, y) + 1600);
  EXPECT_EQ(hot_photosites(dark, 3, 2), kPlaces);
  EXPECT_EQ(hot_photosites(frame_of({640, 480}, 0, 2), 3, 2).size(), 0U) << "of 300000 without fault";
  dark.counts(40, 40) = 600 + 1300;  // 9 percent of the range: the dark shot takes that away
  EXPECT_EQ(hot_photosites(dark, 3, 2), kPlaces);
}

TEST(HotPhotosites, AreNoWarmCornerAndNoBlackLevelOfAFilter) {
  RawFrame dark = frame_of({128, 96}, 0, 1);
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 128; ++x) {
      const double glow = 200 * std::exp(-0.001 * (x * x + y * y)) + (y % 2 == 1 ? 40 : 0);
      dark.counts(x, y) = static_cast<std::uint16_t>(dark.counts(x, y) + glow);
    }
  }
  EXPECT_EQ(hot_photosites(dark, 3, 1).size(), 0U);
}

TEST(HotPhotosites, OfAFrameClippedAtZeroAreJudgedByTheReadNoise) {
  RawFrame dark;
  dark.counts = Image<std::uint16_t>({32, 32});
  dark.white = 200;
  dark.counts(5, 6) = 23;
  dark.counts(9, 9) = 28;
  EXPECT_EQ(hot_photosites(dark, 3, 1), (std::vector<Photosite>{{9, 9}}));
}

TEST(DeadPhotosites, AreFoundAndADarkShotIsNoProof) {
  std::vector<RawFrame> lit = ten_lit({64, 48});
  const RawFrame dark = frame_of({64, 48}, 0, 99);
  EXPECT_EQ(dead_photosites(lit, &dark, 3, 2).size(), 0U);
  for (const auto& [y, x] : kPlaces) {
    if (y == 30) continue;  // two beside each other hide each other: their darkest neighbour is black
    for (RawFrame& frame : lit) frame.counts(x, y) = dark.counts(x, y);
  }
  const std::vector<Photosite> expected = {{0, 0}, {0, 63}, {17, 31}, {47, 63}};
  EXPECT_EQ(dead_photosites(lit, &dark, 3, 2), expected);
  EXPECT_EQ(dead_photosites(lit, nullptr, 3, 1), expected);
}

TEST(DeadPhotosites, AreNotThoseInTheShadowOfAllLedsButOne) {
  std::vector<RawFrame> lit = ten_lit({64, 48});
  for (std::size_t k = 1; k < lit.size(); ++k) lit[k].counts(20, 20) = 600;
  EXPECT_EQ(dead_photosites(lit, nullptr, 3, 1).size(), 0U);
}

void replace_in(RawFrame& frame, const std::vector<Photosite>& bad) {
  replace_photosites(std::array{&frame}, bad, 1);
}

TEST(ReplacedPhotosites, ContinueAYarnAlongItself) {
  std::vector<RawFrame> frames = ten_lit({16, 16});
  for (RawFrame& frame : frames) {
    frame.counts(6, 8) = 2000, frame.counts(10, 8) = 2010;  // along x
    frame.counts(8, 6) = 900, frame.counts(8, 10) = 4000;   // across it
  }
  std::vector<RawFrame*> all;
  for (RawFrame& frame : frames) all.push_back(&frame);
  replace_photosites(all, std::vector<Photosite>{{8, 8}}, 2);
  for (const RawFrame& frame : frames) EXPECT_EQ(frame.counts(8, 8), 2005);
}

TEST(ReplacedPhotosites, HaveTheMeanOfTheirGoodNeighbours) {
  RawFrame frame = frame_of({64, 48}, 0, 1);
  const std::vector<Photosite> bad = {{0, 0}, {10, 10}, {10, 12}, {20, 20}};
  for (int i : {18, 22}) frame.counts(20, i) = 1000, frame.counts(i, 20) = 2000;
  frame.counts(2, 0) = 900, frame.counts(0, 2) = 901;
  frame.counts(10, 8) = frame.counts(10, 12) = 700, frame.counts(8, 10) = 20000, frame.counts(12, 10) = 60000;
  replace_in(frame, bad);
  EXPECT_EQ(frame.counts(20, 20), 1500);
  EXPECT_EQ(frame.counts(0, 0), 901) << "the mean of two at a corner, rounded";
  EXPECT_EQ(frame.counts(10, 10), 700) << "its right neighbour is bad itself";
}

TEST(ReplacedPhotosites, AreFullBesideAFullOne) {
  RawFrame frame = frame_of({16, 16}, 0, 1);
  frame.counts(6, 8) = 15520;
  replace_in(frame, {{8, 8}});
  EXPECT_EQ(frame.counts(8, 8), 15520);
}

TEST(ReplacedPhotosites, StayWhereTheyHaveNoGoodNeighbour) {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>({2, 2});
  frame.counts(1, 1) = 5;
  replace_in(frame, {{1, 1}});
  EXPECT_EQ(frame.counts(1, 1), 5);
  EXPECT_EQ(hot_photosites(frame, 3, 1).size(), 0U) << "nor is there anything to hold it against";
}

}  // namespace
}  // namespace weft
