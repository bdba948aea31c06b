// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/sheet_stories.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "bench/oracles/paper_oracle.h"

namespace weft::calibration {
namespace {

using test::PaperCaptures;

PaperCaptures captures() {
  test::PaperErrors errors;
  errors.noise *= 0.3;
  return test::captures_of(test::common_rig(), errors, 6, 4);
}

/// The same with a light that is `share` of the mean of all LEDs in every reading.
PaperCaptures with_room(double share) {
  PaperCaptures all = captures();
  all.start.lights = test::common_rig().lights;  // a better tape is a quicker fit
  std::map<std::tuple<std::size_t, double, double>, std::pair<std::array<double, 3>, double>> sums;
  for (const PaperReading& r : all.readings) {
    auto& [sum, count] = sums[{r.sheet, r.x_px, r.y_px}];
    for (std::size_t c = 0; c < 3; ++c) sum[c] += r.reading_rgb[c];
    ++count;
  }
  for (PaperReading& r : all.readings) {
    const auto& [sum, count] = sums[{r.sheet, r.x_px, r.y_px}];
    for (std::size_t c = 0; c < 3; ++c) r.reading_rgb[c] += share * sum[c] / count;
  }
  return all;
}

TEST(SheetStories, NameTwoLedsWhoseWiresAreExchangedAndThreeInACircle) {
  PaperCaptures pair = captures();
  EXPECT_FALSE(find_exchanged(pair.start, pair.readings)) << "a tape ten millimetres wrong exchanges none";
  for (PaperReading& r : pair.readings) r.led = r.led == 2 ? 3 : r.led == 3 ? 2 : r.led;
  const auto exchanged = find_exchanged(pair.start, pair.readings);
  ASSERT_TRUE(exchanged);
  for (std::size_t k = 0; k < exchanged->as.size(); ++k)
    EXPECT_EQ(exchanged->as[k], k == 2 ? 3U : k == 3 ? 2U : k);
  EXPECT_GT(exchanged->rms_before, 4 * exchanged->rms_after);

  PaperCaptures circle = captures();
  for (PaperReading& r : circle.readings) r.led = r.led == 0 ? 4 : r.led == 4 ? 5 : r.led == 5 ? 0 : r.led;
  const auto turned = find_exchanged(circle.start, circle.readings);
  ASSERT_TRUE(turned);
  EXPECT_EQ(turned->as[4], 0U);
  EXPECT_EQ(turned->as[5], 4U);
  EXPECT_EQ(turned->as[0], 5U);
}

TEST(SheetStories, FindTheShareOfALightThatDarkShotsLack) {
  constexpr double share = 0.05;
  {
    const PaperCaptures all = with_room(share);
    const Result<LightFit> fit = fit_lights(all.start, all.readings, {});
    ASSERT_TRUE(fit) << fit.error().message();
    EXPECT_TRUE(fit->misfits()) << share;
    const auto room = find_room_light(all.start, all.readings, {}, *fit);
    ASSERT_TRUE(room) << share << ", chi-square " << fit->chi_square;
    EXPECT_NEAR(room->share, share, 0.015);
    EXPECT_TRUE(room->agrees) << room->chi_square;
  }
}

}  // namespace
}  // namespace weft::calibration
