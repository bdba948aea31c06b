// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/poses_ahead.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/oracles/paper_oracle.h"
#include "calibration/lights/physical.h"

namespace weft::calibration {
namespace {

constexpr Sheet kSheet = {
    .width_mm = 297, .height_mm = 210, .margin_mm = 0, .printed = {}, .reflectance_rgb = {}};

LightFit fit_of(const PaperScene& scene, std::span<const PaperReading> readings) {
  Result<LightFit> fit = fit_lights(scene, readings, {});
  EXPECT_TRUE(fit) << fit.error().message();
  return fit ? std::move(*fit) : LightFit();
}

LightFit fit_of_first(std::size_t sheets) {
  test::PaperRig rig = test::common_rig();
  rig.sheets.resize(sheets);
  test::PaperErrors errors;
  errors.noise *= 0.5;
  const test::PaperCaptures captures = test::captures_of(rig, errors, 13, 8);
  return fit_of(captures.start, captures.readings);
}

TEST(PosesAhead, TellTheFitWhatRealOnesWould) {
  test::PaperRig rig = test::common_rig();
  rig.sheets.resize(2);
  test::PaperErrors errors;
  errors.noise *= 0.5;
  const test::PaperCaptures captures = test::captures_of(rig, errors, 13, 8);
  const LightFit two = fit_of(captures.start, captures.readings);
  const PaperPhotographs five = with_more_poses(two.scene, captures.readings, kSheet, 3);
  ASSERT_EQ(five.scene.sheets.size(), 5u);
  const double foretold = fit_of(five.scene, five.readings).worst_position_sigma_mm();
  const double real = fit_of_first(5).worst_position_sigma_mm(), before = two.worst_position_sigma_mm();
  EXPECT_LT(foretold, 0.8 * before);
  EXPECT_NEAR(std::log2(foretold / real), 0, 1)
      << before << " mm by two, " << foretold << " foretold of five, " << real;
}

TEST(PosesAhead, TellNoLessTheMoreThereAre) {
  test::PaperRig rig = test::common_rig();
  rig.sheets.resize(1);
  const test::PaperCaptures captures = test::captures_of(rig, {}, 9, 6);
  const LightFit one = fit_of(captures.start, captures.readings);
  double before = one.worst_position_sigma_mm();
  for (const int more : {1, 2, 5}) {
    const PaperPhotographs all = with_more_poses(one.scene, captures.readings, kSheet, more);
    const double now = fit_of(all.scene, all.readings).worst_position_sigma_mm();
    EXPECT_LT(now, before) << more;
    before = now;
  }
}

TEST(PosesAhead, AreNoneWhereNoneAreAskedFor) {
  const test::PaperCaptures captures = test::captures_of(test::common_rig(), {}, 5, 3);
  const PaperPhotographs same = with_more_poses(captures.start, captures.readings, kSheet, 0);
  EXPECT_EQ(same.scene.sheets.size(), captures.start.sheets.size());
  EXPECT_EQ(same.readings.size(), captures.readings.size());
}

}  // namespace
}  // namespace weft::calibration
