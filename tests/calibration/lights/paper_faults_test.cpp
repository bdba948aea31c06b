// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/paper_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/oracles/paper_oracle.h"

namespace weft::calibration {
namespace {

using testing::ElementsAre;

constexpr int kBlockColumns = 40, kBlockRows = 26;
constexpr double kSpacing_mm = 2464 * 0.08 / kBlockColumns;

// The rig's own numbers as the fit, captures of two sheets, by block with all LEDs side by side.
struct Captured {
  PaperScene scene;
  std::vector<PaperReading> readings;

  Captured() {
    test::PaperRig rig = test::common_rig();
    rig.vignette = 0;
    rig.sheets = {{}, {20, 90, 0, {}}};
    auto captures = test::captures_of(rig, {.noise = 0.0005, .tape_mm = 0, .turn_deg = 0, .shift_mm = 0},
                                      kBlockColumns, kBlockRows);
    scene = captures.start;
    scene.lights = rig.lights;
    scene.paper.log_albedo = rig.log_albedo;
    readings = std::move(captures.readings);
    std::stable_sort(readings.begin(), readings.end(), [](const PaperReading& a, const PaperReading& b) {
      return std::tie(a.sheet, a.y_px, a.x_px) < std::tie(b.sheet, b.y_px, b.x_px);
    });
  }

  Vec3 on_sheet(const PaperReading& r) const {
    const Pose& pose = scene.sheets[r.sheet].rig_from_sheet;
    const Vec3 p = *point_on_sheet(sight_of(scene.camera, r.x_px, r.y_px), pose) - pose.translation_mm;
    return {dot(p, u_axis(pose)), dot(p, v_axis(pose)), 0};
  }
  std::vector<PaperFault> faults() const { return find_faults(spots_of(scene, readings), kSpacing_mm); }
};

TEST(PaperFaults, AreNoneOnCleanPaper) {
  EXPECT_TRUE(Captured().faults().empty());
}

TEST(PaperFaults, OfAStainAreNamedWithTheirPlaceOnTheSheet) {
  Captured captured;
  for (PaperReading& r : captured.readings) {
    if (length(captured.on_sheet(r) - Vec3{40, -20, 0}) > 12) continue;
    for (double& reading : r.reading_rgb) reading *= 0.95;
  }
  const std::vector<PaperFault> faults = captured.faults();
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_FALSE(faults[0].is_fold);
  EXPECT_NEAR(faults[0].u_mm, 40, 2);
  EXPECT_NEAR(faults[0].v_mm, -20, 2);
  EXPECT_NEAR(faults[0].area_mm2, kPi * 12 * 12, 100);
  EXPECT_NEAR(faults[0].departure, 0.05, 0.005);
  EXPECT_THAT(faults[0].sheets, ElementsAre(0, 1)) << "a stain turns with the sheet";
}

TEST(PaperFaults, OfAFoldAreToldFromStainsByWhatEachLedSees) {
  Captured captured;
  for (PaperReading& r : captured.readings) {
    const Vec3 at = captured.on_sheet(r);
    if (r.sheet != 1 || std::abs(at.x + 30) > 4) continue;
    // Paper that leans by 2 degrees towards u.
    const Pose& pose = captured.scene.sheets[1].rig_from_sheet;
    const Vec3 point = *point_on_sheet(sight_of(captured.scene.camera, r.x_px, r.y_px), pose);
    const Vec3 l = normalized(captured.scene.lights.leds[r.led].position_mm - point);
    const Vec3 leaning = normalized(normal_of(pose) + std::tan(radians(2)) * u_axis(pose));
    for (double& reading : r.reading_rgb) reading *= dot(leaning, l) / dot(normal_of(pose), l);
  }
  const std::vector<PaperFault> faults = captured.faults();
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_TRUE(faults[0].is_fold);
  EXPECT_NEAR(faults[0].u_mm, -30, 3);
  EXPECT_THAT(faults[0].sheets, ElementsAre(1));
}

}  // namespace
}  // namespace weft::calibration
