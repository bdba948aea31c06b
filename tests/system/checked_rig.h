// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <utility>

#include "calibration/run/rig_evidence.h"
#include "core/rig/calibration.h"
#include "simulator/captures_layout.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"

namespace weft::test {

/// 600 x 400 pixels over 200 mm of table, with tags and white patches on it.
inline simulator::Scene checked_rig() {
  simulator::Scene scene;
  scene.fabric = "grey card";
  scene.camera.width = 600;
  scene.camera.height = 400;
  scene.camera.mm_per_pixel = 200.0 / 600;
  scene.material.albedo.fill(0.2);
  scene.effects.near_light = true;
  for (const double y : {58.0, -58.0}) {
    for (const double x : {-45.0, 45.0}) {
      simulator::TargetSettings& patch = scene.targets.emplace_back();
      patch.pattern = simulator::PaperSettings{14, 12};
      patch.centre_mm = {x, y, 0.3};
      patch.white = 0.88;
    }
  }
  const CameraModel camera = simulator::rig_of(scene)->camera;
  simulator::Scene bare = scene;
  bare.targets.clear();
  for (const simulator::TargetSettings& tag : simulator::furniture(bare, camera))
    scene.targets.push_back(tag);
  return scene;
}

/// One folder for all tests of a suite: a session, and what was calibrated from it.
class CheckedRig : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = std::filesystem::path(testing::TempDir()) / ("weft_checked_rig_" + std::to_string(getpid()));
    std::filesystem::create_directories(root_);
    simulate(checked_rig(), "cloth.weft");
    calibrate();
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(root_); }

  static void simulate(const simulator::Scene& scene, const char* name) {
    simulator::SimulateOptions options;
    options.truth = false;
    const auto report = simulator::simulate_session(scene, root_ / name, options);
    ASSERT_TRUE(report) << report.error().message();
  }

  /// The exact calibration with the tags that the session shows and its patches.
  static void calibrate() {
    const auto plan = solve::plan_session({root_ / "cloth.weft", {}, {}});
    ASSERT_TRUE(plan) << plan.error().message();
    const auto loaded = solve::load_photographs(*plan, {});
    ASSERT_TRUE(loaded) << loaded.error().message();
    const auto tags = calibration::tags_in(*loaded, {simulator::TagSettings().dictionary});
    ASSERT_TRUE(tags) << tags.error().message();
    ASSERT_EQ(tags->size(), 4U);
    Calibration rig = plan->calibration;
    for (const calibration::TagSighting& tag : *tags) {
      Fiducial& fiducial = rig.fiducials.emplace_back(Fiducial{tag.dictionary, tag.id, {}});
      for (std::size_t i = 0; i < 4; ++i)
        fiducial.corners_mm[i] = point_on_plane(*rig.camera, tag.corners_px[i].x, tag.corners_px[i].y, 0.3);
    }
    for (const simulator::TargetSettings& target : checked_rig().targets) {
      if (kind_of(target.pattern) != simulator::TargetKind::kPaper) continue;
      WhitePatch& patch = rig.patches.emplace_back();
      patch.reflectance_rgb.fill(0.88);
      for (const auto& [x, y] : {std::pair{-6.0, 5.0}, {6.0, 5.0}, {6.0, -5.0}, {-6.0, -5.0}}) {
        const Vec3 p = project(*rig.camera, target.centre_mm + Vec3{x, y, 0});
        patch.polygon_px.push_back({p.x, p.y});
      }
    }
    rig.camera_covariance = ParameterCovariance{{"camera_from_rig_translation_mm.z"}, {0.01}};
    rig.subject.measured = "2026-03-01T08:00:00Z";
    const auto written = write_calibration(root_ / "rig" / "first", rig);
    ASSERT_TRUE(written) << written.error().message();
  }

  static simulator::Scene with_table_lower() {
    simulator::Scene scene = checked_rig();
    for (simulator::TargetSettings& target : scene.targets) target.centre_mm.z -= 2;
    scene.geometry.cloth_height_mm = -2;
    return scene;
  }

  static inline std::filesystem::path root_;
};

}  // namespace weft::test
