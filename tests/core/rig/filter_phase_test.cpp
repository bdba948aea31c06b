// SPDX-License-Identifier: Apache-2.0
#include "core/rig/filter_phase.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

namespace weft {
namespace {

// A cloth of yarns under light of one colour, as a body whose filters lie off by so much records it.
RawFrame seen(std::array<double, 3> rgb, int rows_off, int columns_off, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 20);
  RawFrame frame;
  frame.counts = Image<std::uint16_t>({128, 96});
  frame.black = {{{600, 600}, {600, 600}}};
  frame.white = 15520;
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 128; ++x) {
      const double weave = 1 + 0.4 * std::sin(0.9 * x) * std::cos(0.7 * y);
      const int channel = frame.cfa.channel_at(x + columns_off, y + rows_off);
      frame.counts(x, y) = static_cast<std::uint16_t>(
          600 + 5000 * weave * rgb[static_cast<std::size_t>(channel)] + noise(random));
    }
  return frame;
}

std::vector<FilterShift> shifts_of(const std::vector<RawFrame>& frames) {
  std::vector<std::optional<SiteLight>> light;
  for (const RawFrame& frame : frames) light.push_back(site_light(frame));
  return filter_shifts(light, CfaPattern());
}

constexpr std::array<double, 3> kCloth = {0.5, 1.0, 0.7}, kGrey = {1, 1, 1};

TEST(FilterShift, IsToldOfTheOneFrameThatLiesARowOrAColumnOff) {
  std::vector<RawFrame> frames;
  for (unsigned k = 0; k < 6; ++k) frames.push_back(seen(kCloth, k == 4 ? 1 : 0, k == 2 ? 1 : 0, k));
  using enum FilterShift;
  EXPECT_EQ(shifts_of(frames), (std::vector{kNone, kNone, kColumn, kNone, kRow, kNone}));
}

TEST(FilterShift, IsToldWhereRedAndBlueAreAlike) {
  std::vector<RawFrame> frames;
  for (unsigned k = 0; k < 6; ++k) frames.push_back(seen({0.6, 1.0, 0.6}, k == 4 ? 1 : 0, 0, k));
  const std::vector<FilterShift> shifts = shifts_of(frames);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(shifts[k] != FilterShift::kNone, k == 4) << "frame " << k;
}

TEST(FilterShift, IsToldOfAllFramesByTheirGreens) {
  std::vector<RawFrame> frames;
  for (unsigned k = 0; k < 6; ++k) frames.push_back(seen(kCloth, 1, 0, k));
  for (const FilterShift shift : shifts_of(frames)) EXPECT_EQ(shift, FilterShift::kRowOrColumn);
}

TEST(FilterShift, IsNotToldOfGreyClothOrOfALampOfAnotherColour) {
  std::vector<RawFrame> grey, lamps;
  for (unsigned k = 0; k < 6; ++k) {
    grey.push_back(seen(kGrey, k == 3 ? 1 : 0, 0, k));
    lamps.push_back(seen(k == 3 ? std::array{0.9, 0.5, 0.2} : kCloth, 0, 0, k));
  }
  for (const auto& frames : {&grey, &lamps})
    for (const FilterShift shift : shifts_of(*frames)) EXPECT_EQ(shift, FilterShift::kNone);
}

TEST(FilterShift, IsNotToldOfFramesThatAreDarkOrFull) {
  std::vector<RawFrame> frames;
  for (unsigned k = 0; k < 6; ++k) frames.push_back(seen({0.01, 0.02, 0.01}, k == 1 ? 1 : 0, 0, k));
  EXPECT_FALSE(site_light(frames[1]).has_value());
  for (const FilterShift shift : shifts_of(frames)) EXPECT_EQ(shift, FilterShift::kNone);
}

}  // namespace
}  // namespace weft
