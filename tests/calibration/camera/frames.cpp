// SPDX-License-Identifier: Apache-2.0
#include "tests/calibration/camera/frames.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "capture/raw/decode_raw.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"
#include "simulator/targets/target.h"

namespace weft::test {

simulator::Scene board_scene() {
  simulator::Scene scene;
  scene.camera.width = 640;
  scene.camera.height = 420;
  scene.camera.mm_per_pixel = 0.3;
  scene.camera.pose = {.tilt_deg = 2, .azimuth_deg = 40};
  scene.camera.lens = {.k1 = -0.1, .k2 = 0.05, .offset_x_px = 6, .offset_y_px = -4};
  scene.camera.blur = {.defocus_px = 0.8, .spread_px = 0.6};
  scene.material.albedo = {0.15, 0.15, 0.15};
  scene.lights.leds.resize(1);
  scene.lights.leds[0].position_mm = {150, 80, 560};
  scene.effects.near_light = scene.effects.distortion = scene.effects.defocus = scene.effects.noise = true;
  return scene;
}

RawFrame photographed(const simulator::Scene& scene) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("weft_frame_" + std::to_string(getpid()) + ".dng");
  const Result<void> taken = simulator::simulate_frame(scene, 1, file, {});
  EXPECT_TRUE(taken) << taken.error().message();
  Result<RawFrame> frame = capture::decode_raw(file);
  EXPECT_TRUE(frame) << frame.error().message();
  std::filesystem::remove(file);
  return frame ? std::move(*frame) : RawFrame();
}

CameraModel camera_of(const simulator::Scene& scene) {
  const Result<simulator::SceneRig> rig = simulator::rig_of(scene);
  EXPECT_TRUE(rig) << rig.error().message();
  return rig ? rig->camera : CameraModel();
}

calibration::Pose pose_of(const simulator::TargetSettings& settings) {
  const Result<simulator::Target> target = simulator::Target::make(settings, 1, 0);
  EXPECT_TRUE(target) << target.error().message();
  const Vec3 o = target->place_mm(0, 0), u = target->place_mm(1, 0) - o, v = target->place_mm(0, 1) - o;
  const Vec3 n = target->normal();
  return {{{{u.x, v.x, n.x}, {u.y, v.y, n.y}, {u.z, v.z, n.z}}}, o};
}

calibration::PixelPoint seen_at(const simulator::Scene& scene, std::size_t target, double u_mm, double v_mm) {
  const Vec3 p = project(camera_of(scene), pose_of(scene.targets[target])({u_mm, v_mm, 0}));
  return {p.x, p.y};
}

Offsets offsets_of(const std::vector<calibration::PixelPoint>& differences) {
  Offsets out;
  const auto n = static_cast<double>(differences.size());
  for (const calibration::PixelPoint& d : differences) {
    out.mean_x += d.x / n;
    out.mean_y += d.y / n;
    out.rms += (d.x * d.x + d.y * d.y) / n;
    out.farthest = std::max(out.farthest, std::hypot(d.x, d.y));
  }
  out.rms = std::sqrt(out.rms);
  return out;
}

}  // namespace weft::test
