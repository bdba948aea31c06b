// SPDX-License-Identifier: Apache-2.0
#include "calibration/color/chart_reference.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "core/image/color_spaces.h"

namespace weft::calibration {
namespace {

TEST(ChartReference, IsNearTheValuesCommonlyGivenInSrgb) {
  // As 8 bits: X-Rite's sRGB of patches 1, 13, 15, 19 and 22.
  const std::array<std::pair<std::size_t, Rgb>, 5> srgb = {{{0, {115, 82, 68}},
                                                            {12, {56, 61, 150}},
                                                            {14, {175, 54, 60}},
                                                            {18, {243, 243, 242}},
                                                            {21, {122, 122, 121}}}};
  for (const ChartReference& chart : {published_chart(), published_chart_before_2014()}) {
    for (const auto& [patch, display] : srgb) {
      const Rgb rgb = rec709_of_srgb({display[0] / 255, display[1] / 255, display[2] / 255});
      const double off = ciede2000(lab_of_rec709(rgb), lab_of_rec709(chart[patch]));
      EXPECT_LT(off, 4) << patch_name(static_cast<int>(patch));
    }
  }
  EXPECT_LT(published_chart()[17][0], 0) << "cyan is outside Rec.709";
}

}  // namespace
}  // namespace weft::calibration
