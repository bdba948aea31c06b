// SPDX-License-Identifier: Apache-2.0
#include "tests/virtual_rig/small_scene.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <system_error>

namespace weft::virtual_rig {

namespace fs = std::filesystem;

simulator::Scene small_scene(int width) {
  simulator::Scene scene;
  scene.camera.width = width;
  scene.camera.height = 96;
  scene.camera.body = simulator::Body::kD5100;
  scene.geometry.kind = simulator::GeometryKind::kSatin;
  scene.material.albedo = {0.45, 0.3, 0.2};
  scene.lights.rings = {{3, 45, 10, 500}};
  scene.effects.near_light = true;
  scene.effects.noise = true;
  return scene;
}

fs::path fresh_folder() {
  // A folder of this process alone, and gone with it.
  struct Own {
    const fs::path path = fs::path(testing::TempDir()) / ("weft_rig_" + std::to_string(getpid()));
    ~Own() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
  };
  static const Own own;
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder = own.path / test.test_suite_name() / test.name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

}  // namespace weft::virtual_rig
