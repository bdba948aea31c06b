// SPDX-License-Identifier: Apache-2.0
#include "calibration/checks/rig_movement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>

#include "bench/oracles/oracle_rig.h"
#include "tests/calibration/checks/moved_rig.h"

namespace weft::calibration {
namespace {

using test::Mishap;
constexpr int kSeeds = 5;

const char* name_of(ChangeKind kind) {
  constexpr const char* kNames[] = {"camera", "table", "led moved", "led faded", "leds swapped", "all faded"};
  return kNames[static_cast<int>(kind)];
}

std::string told(const Movement& movement) {
  std::string text;
  for (const RigChange& c : movement.changes) {
    text += name_of(c.kind);
    text += " " + std::to_string(c.led) + "/" + std::to_string(c.other_led) + " shift " +
            std::to_string(c.shift_mm.x) + " " + std::to_string(c.shift_mm.y) + " " +
            std::to_string(c.shift_mm.z) + " factor " + std::to_string(c.factor) + " evidence " +
            std::to_string(c.evidence) + "; ";
  }
  return text + "chi-square " + std::to_string(movement.chi_square_before) + " to " +
         std::to_string(movement.chi_square_after);
}

Movement found(const Calibration& rig, const RigEvidence& evidence) {
  Result<Movement> movement = find_movement(rig, evidence);
  EXPECT_TRUE(movement) << movement.error().message();
  return movement ? *movement : Movement();
}

/// Runs body(movement) for what is found of the mishap in each of several sessions.
template <typename Body>
void for_each_session(const Mishap& mishap, const Body& body, decltype(&test::seen) seen = test::seen) {
  const Calibration rig = test::calibrated_rig();
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Movement movement = found(rig, seen(rig, mishap, static_cast<std::uint64_t>(seed)));
    SCOPED_TRACE(told(movement));
    body(movement);
  }
}

TEST(Movement, InventsNothingOnARigThatStoodStill) {
  for_each_session(test::no_mishap(test::calibrated_rig()), [](const Movement& movement) {
    EXPECT_TRUE(movement.changes.empty());
    EXPECT_LT(movement.chi_square_before, 1.5);
  });
}

/// Eight points along the edges of a table without tags, seen by a camera that was knocked.
RigEvidence points_seen(const CameraModel& camera, test::Random& random) {
  RigEvidence evidence;
  for (int i = 0; i < 8; ++i) {
    const double sigma_px = 0.05 + 0.02 * i;
    const Vec3 point = {25.0 * i - 87, i % 2 == 0 ? 55.0 : -55.0, 0};
    const Vec3 p = project(camera, point);
    evidence.points.push_back(
        {point, {p.x + sigma_px * random.normal(), p.y + sigma_px * random.normal()}, sigma_px});
  }
  return evidence;
}

TEST(Movement, IsNotInventedByFixedPointsThatStoodStill) {
  const Calibration rig = test::calibrated_rig();
  test::Random random(1);
  for (int draw = 0; draw < 300; ++draw) {
    const Movement movement = found(rig, points_seen(*rig.camera, random));
    ASSERT_TRUE(movement.changes.empty()) << "draw " << draw << ": " << told(movement);
    EXPECT_EQ(movement.points, 8);
    EXPECT_EQ(movement.corners, 0);
  }
}

TEST(Movement, IsToldByFixedPointsWithItsCost) {
  const Calibration rig = test::calibrated_rig();
  const NearLights& lights = std::get<NearLights>(*rig.lights);
  test::Random random(2);
  for (int draw = 0; draw < 30; ++draw) {
    const double size_mm = 1 + 4 * random.uniform(), azimuth = 6.28 * random.uniform();
    CameraModel camera = *rig.camera;
    camera.camera_from_rig_translation_mm =
        camera.camera_from_rig_translation_mm + size_mm * Vec3{std::cos(azimuth), std::sin(azimuth), 0};
    const Movement movement = found(rig, points_seen(camera, random));
    ASSERT_EQ(movement.changes.size(), 1U) << told(movement);
    EXPECT_EQ(movement.changes[0].alternatives.size(), 1U) << "camera or table: " << told(movement);
    const double cost = cost_of(*rig.camera, lights, movement.camera, lights).mean_deg,
                 truth = cost_of(*rig.camera, lights, camera, lights).mean_deg;
    EXPECT_NEAR(cost, truth, 0.02) << size_mm << " mm";
  }
}

TEST(Movement, FindsTheTableTwoMillimetresLower) {
  Mishap mishap = test::no_mishap(test::calibrated_rig());
  mishap.table.translation_mm = {0, 0, -2};
  for_each_session(mishap, [](const Movement& movement) {
    ASSERT_EQ(movement.changes.size(), 1U);
    const RigChange& change = movement.changes[0];
    EXPECT_EQ(change.kind, ChangeKind::kTable);
    EXPECT_NEAR(change.shift_mm.z, -2, 5 * change.shift_sigma_mm.z);
    EXPECT_LT(change.shift_sigma_mm.z, 0.1);
  });
}

TEST(Movement, FindsTheCameraTilted) {
  Mishap mishap = test::no_mishap(test::calibrated_rig());
  const Vec3 centre = {0, 0, 600};
  const Mat3 turn = rotation_of({0, radians(0.3), 0});
  mishap.camera = {turn, centre - turn * centre};
  for_each_session(mishap, [](const Movement& movement) {
    ASSERT_EQ(movement.changes.size(), 1U);
    const RigChange& change = movement.changes[0];
    EXPECT_EQ(change.kind, ChangeKind::kCamera);
    EXPECT_NEAR(change.turn_deg.y, 0.3, 5 * change.turn_sigma_deg.y);
    EXPECT_LT(change.turn_sigma_deg.y, 0.03);
  });
}

TEST(Movement, FindsALedThatWasShiftedInAnyDirection) {
  for (const Vec3 shift : {Vec3{5, 0, 0}, Vec3{0, 5, 0}, Vec3{0, 0, 5}, Vec3{3, -3, 2.6}}) {
    Mishap mishap = test::no_mishap(test::calibrated_rig());
    mishap.leds[6].position_mm = mishap.leds[6].position_mm + shift;
    const auto check = [&](const Movement& movement) {
      ASSERT_EQ(movement.changes.size(), 1U);
      const RigChange& change = movement.changes[0];
      EXPECT_EQ(change.kind, ChangeKind::kLedMoved);
      EXPECT_EQ(change.led, 7);
      EXPECT_LT(length(change.shift_mm - shift), 2.5);
    };
    for_each_session(mishap, check, test::seen_with_sheet);
  }
}

TEST(Movement, FindsTwoLedsSwapped) {
  Mishap mishap = test::no_mishap(test::calibrated_rig());
  std::swap(mishap.leds[1], mishap.leds[4]);
  for_each_session(mishap, [](const Movement& movement) {
    ASSERT_EQ(movement.changes.size(), 1U);
    EXPECT_EQ(movement.changes[0].kind, ChangeKind::kLedsSwapped);
    EXPECT_EQ(movement.changes[0].led, 2);
    EXPECT_EQ(movement.changes[0].other_led, 5);
  });
}

TEST(Movement, FindsALedAtNinetySevenPercent) {
  Mishap mishap = test::no_mishap(test::calibrated_rig());
  for (double& flux : mishap.leds[8].flux_rgb) flux *= 0.97;
  for_each_session(mishap, [](const Movement& movement) {
    ASSERT_EQ(movement.changes.size(), 1U);
    EXPECT_EQ(movement.changes[0].kind, ChangeKind::kLedFaded);
    EXPECT_EQ(movement.changes[0].led, 9);
    EXPECT_NEAR(movement.changes[0].factor, 0.97, 4 * movement.changes[0].factor_sigma);
  });
}

TEST(Movement, FindsTwoThingsAtOnce) {
  Mishap mishap = test::no_mishap(test::calibrated_rig());
  mishap.table.translation_mm = {0, 0, -2};
  for (double& flux : mishap.leds[2].flux_rgb) flux *= 0.95;
  for_each_session(mishap, [](const Movement& movement) {
    ASSERT_EQ(movement.changes.size(), 2U);
    const bool table_first = movement.changes[0].kind == ChangeKind::kTable;
    EXPECT_EQ(movement.changes[table_first ? 0 : 1].kind, ChangeKind::kTable);
    EXPECT_EQ(movement.changes[table_first ? 1 : 0].kind, ChangeKind::kLedFaded);
    EXPECT_EQ(movement.changes[table_first ? 1 : 0].led, 3);
  });
}

TEST(Movement, SaysThatTagsAloneCannotTellCameraFromTable) {
  const Calibration rig = test::calibrated_rig();
  Mishap mishap = test::no_mishap(rig);
  mishap.table.translation_mm = {0, 0, -2};
  RigEvidence evidence = test::seen(rig, mishap, 1);
  evidence.places.clear();
  const Movement movement = found(rig, evidence);
  ASSERT_EQ(movement.changes.size(), 1U) << told(movement);
  ASSERT_EQ(movement.changes[0].alternatives.size(), 1U);
  const bool camera = movement.changes[0].kind == ChangeKind::kCamera;
  EXPECT_EQ(movement.changes[0].alternatives[0].kind, camera ? ChangeKind::kTable : ChangeKind::kCamera);
}

TEST(Movement, GivesTheRigAsItIsNowInTheFrameOfItsTable) {
  const Calibration rig = test::calibrated_rig();
  Mishap mishap = test::no_mishap(rig);
  mishap.table.translation_mm = {0, 0, -2};
  const Movement movement = found(rig, test::seen(rig, mishap, 3));
  const std::vector<NearLight>& before = std::get<NearLights>(*rig.lights).leds;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const Vec3 higher = before[k].position_mm + Vec3{0, 0, 2};
    EXPECT_LT(length(movement.lights.leds[k].position_mm - higher), 0.5) << "LED " << k + 1;
  }
  // What is on the table is seen where it is.
  const Vec3 real = project(*rig.camera, {40, 20, -2});
  const Vec3 by_update = project(movement.camera, {40, 20, 0});
  EXPECT_LT(std::hypot(real.x - by_update.x, real.y - by_update.y), 0.2);
}

TEST(Movement, IsRefusedWithoutEvidence) {
  const Result<Movement> movement = find_movement(test::calibrated_rig(), RigEvidence());
  ASSERT_FALSE(movement);
  EXPECT_EQ(movement.error().kind, ErrorKind::kBadData);
}

TEST(Movement, LeavesAPatchThatIsCoveredUnexplained) {
  const Calibration rig = test::calibrated_rig();
  RigEvidence evidence = test::seen(rig, test::no_mishap(rig), 1);
  for (auto& reading : evidence.places[2].reading_rgb) {
    for (double& r : reading) r *= 0.3;
  }
  const Movement movement = found(rig, evidence);
  EXPECT_GT(movement.chi_square_after, kUnexplainedFrom) << told(movement);
}

TEST(Movement, ReadingsThatAreNoNumbersAreNotUsed) {
  const Calibration rig = test::calibrated_rig();
  RigEvidence evidence = test::seen(rig, test::no_mishap(rig), 1);
  for (LitPlace& place : evidence.places) {
    place.reading_rgb[0].fill(std::nan(""));
    place.reading_rgb[1].fill(0);
    place.reading_rgb[2].fill(-1);
    place.reading_rgb[3].fill(INFINITY);
  }
  const Movement movement = found(rig, evidence);
  EXPECT_TRUE(movement.changes.empty()) << told(movement);
  EXPECT_EQ(movement.readings, 6 * 8);
}

TEST(MovementCost, IsNothingForTheSameRig) {
  const Calibration rig = test::calibrated_rig();
  const NearLights& lights = std::get<NearLights>(*rig.lights);
  EXPECT_LT(cost_of(*rig.camera, lights, *rig.camera, lights).worst_deg, 1e-9);
}

TEST(MovementCost, OfLightsThatAreAllTurnedIsTheirAngle) {
  const Calibration rig = test::calibrated_rig();
  const NearLights& before = std::get<NearLights>(*rig.lights);
  NearLights after = before;
  // Far away, so that turning is all that matters.
  NearLights far_before = before;
  const Mat3 turn = rotation_of({radians(0.5), 0, 0});
  for (std::size_t k = 0; k < after.leds.size(); ++k) {
    far_before.leds[k].position_mm = 1000.0 * before.leds[k].position_mm;
    after.leds[k].position_mm = turn * far_before.leds[k].position_mm;
    after.leds[k].aim = turn * before.leds[k].aim;
  }
  const MovementCost cost = cost_of(*rig.camera, far_before, *rig.camera, after);
  // A turn about x leaves the part of a normal along x.
  EXPECT_NEAR(cost.worst_deg, 0.5, 0.003);
  EXPECT_GT(cost.mean_deg, 0.4);
}

}  // namespace
}  // namespace weft::calibration
