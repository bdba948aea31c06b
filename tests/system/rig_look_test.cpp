// SPDX-License-Identifier: Apache-2.0
// What scans show of their rig, and which of them a new calibration concerns.
#include "calibration/run/rig_look.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <utility>
#include <variant>
#include <vector>

#include "calibration/run/calibrate_patches.h"
#include "calibration/run/history.h"
#include "calibration/run/tag_cards.h"
#include "calibration/run/update.h"
#include "core/base/files.h"
#include "core/rig/session.h"
#include "solve/run/solve_session.h"
#include "tests/system/checked_rig.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using test::checked_rig;
using testing::HasSubstr;

using RigLook = test::CheckedRig;

TEST_F(RigLook, EachScanTellsItselfWhetherTheRigHadMoved) {
  const fs::path rig = root_ / "watched rig", scans = root_ / "scans", second = rig / "second";
  fs::create_directories(rig);
  fs::copy(root_ / "rig" / "first", rig / "first", fs::copy_options::recursive);
  fs::create_directories(scans);
  simulator::SimulateOptions options;
  options.truth = false;
  options.calibration = *read_calibration(rig / "first");
  for (const auto& [name, scene] :
       {std::pair{"still.weft", checked_rig()}, {"sunk.weft", with_table_lower()}}) {
    ASSERT_TRUE(simulator::simulate_session(scene, scans / name, options));
    Session session = *read_session(scans / name);
    for (Shot& shot : session.shots) shot.time = "2026-03-02T08:00:00Z";
    ASSERT_TRUE(write_session(session));
  }

  const auto still = calibration::look_at_scan(*read_session(scans / "still.weft"), {});
  ASSERT_TRUE(still) << still.error().message();
  EXPECT_EQ(still->says, "in place");
  const auto sunk = calibration::look_at_scan(*read_session(scans / "sunk.weft"), {});
  ASSERT_TRUE(sunk) << sunk.error().message();
  EXPECT_EQ(sunk->state, RigPlace::kMoved);
  EXPECT_THAT(sunk->says, testing::StartsWith("table moved 2.0 mm, costs 0."));
  const auto kept = calibration::kept_look(*read_session(scans / "sunk.weft"));
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->says, sunk->says);

  const auto update = calibration::calibrate_update(
      {.session = scans / "sunk.weft", .from = rig / "first", .output = second}, {});
  ASSERT_TRUE(update) << update.error().message();
  const auto by_second = calibration::look_by_another(*kept, second);
  ASSERT_TRUE(by_second) << by_second.error().message();
  EXPECT_EQ(by_second->says, "in place") << "no photograph is read again";

  // No check says when: only the scan that shows the move is concerned, until it is solved by the new one.
  const auto history = calibration::calibrate_history({rig, scans, {}, second}, {});
  ASSERT_TRUE(history) << history.error().message();
  EXPECT_EQ(history->looks.size(), 2U);
  ASSERT_EQ(history->affected.size(), 1U);
  EXPECT_EQ(history->affected[0].folder.filename(), "sunk.weft");
  EXPECT_TRUE(history->affected[0].is_concerned);
  EXPECT_EQ(history->affected[0].predicted_mean_deg, sunk->cost.mean_deg);
  solve::SolveOptions fast;
  fast.method = "fast";
  ASSERT_TRUE(solve::solve_session({scans / "sunk.weft", second, {}}, fast, {}));
  const auto solved = calibration::calibrate_history({rig, scans, {}, second}, {});
  ASSERT_TRUE(solved) << solved.error().message();
  EXPECT_TRUE(solved->affected.empty());
}

TEST_F(RigLook, WhereNothingOfTheRigIsInSightThatIsSaid) {
  const auto look = calibration::look_by(*read_calibration(root_ / "rig" / "first"), {});
  EXPECT_EQ(look.state, RigPlace::kUnseen);
  EXPECT_THAT(look.says, HasSubstr("nothing of the rig is in sight"));
}

TEST_F(RigLook, WhatTheClothToldOfLedsIsSaidAsLongAsTheCalibrationIsThatOne) {
  const fs::path first = root_ / "rig" / "first";
  calibration::RigLook look;
  look.calibration = read_calibration(first)->id;
  look.state = RigPlace::kInPlace;
  const ClothGains gains = {.leds = {{3, 0.976, 0.001}, {4, 1.004, 0.001}}};
  look = calibration::with_cloth_gains(std::move(look), gains);
  EXPECT_EQ(look.state, RigPlace::kDimmed);
  EXPECT_THAT(look.says, testing::StartsWith("LED 3 weaker by 2.4 percent, which the cloth tells"));
  EXPECT_EQ(calibration::look_by_now(look, first).says, look.says);
}

TEST_F(RigLook, TheWhiteOfPrintedCardsNeedsNoFileOfPatches) {
  simulator::Scene scene = checked_rig();
  std::erase_if(scene.targets,
                [](const auto& target) { return kind_of(target.pattern) != simulator::TargetKind::kTag; });
  const std::vector<simulator::TargetSettings> tags = scene.targets;
  for (const simulator::TargetSettings& tag : tags) {
    const auto& [dictionary, id, side_mm, margin_mm] = std::get<simulator::TagSettings>(tag.pattern);
    simulator::TargetSettings& white = scene.targets.emplace_back(tag);
    white.pattern = simulator::PaperSettings{calibration::kCardWhite * side_mm, 1.5 * side_mm};
    white.white = 0.88;
    white.centre_mm.x += (id % 2 == 0 ? 1 : -1) * (0.75 + calibration::kCardWhite / 2) * side_mm;
  }
  Calibration known = *read_calibration(root_ / "rig" / "first");
  known.patches.clear();
  simulator::SimulateOptions options;
  options.truth = false;
  options.calibration = known;
  const fs::path rig = root_ / "rig with cards";
  fs::create_directories(rig / "scans");
  ASSERT_TRUE(simulator::simulate_session(scene, rig / "scans" / "table.weft", options));
  const auto nobody_said = calibration::calibrate_patches(
      {.session = rig / "scans" / "table.weft", .output = rig / "with patches"}, {});
  ASSERT_FALSE(nobody_said) << "no card was printed";

  fs::create_directories(rig / "targets");
  ASSERT_TRUE(write_file(rig / "targets" / "tags.toml", "# cards\n"));
  const auto measured = calibration::calibrate_patches(
      {.session = rig / "scans" / "table.weft", .output = rig / "with patches"}, {});
  ASSERT_TRUE(measured) << measured.error().message();
  ASSERT_EQ(measured->calibration.patches.size(), 4U);
  for (const WhitePatch& patch : measured->calibration.patches)
    EXPECT_NEAR(patch.reflectance_rgb[1], 0.88, 0.01);
}

}  // namespace
}  // namespace weft::app
