// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/board_views.h"

#include <cmath>
#include <string>

#include "bench/oracles/oracle_rig.h"

namespace weft::test {

using calibration::BoardView;
using calibration::moved;
using calibration::Pose;
using calibration::rotation_of;

BoardRig::BoardRig() : camera(overhead_camera({2464, 1632}, 600, 0.0812)) {
  camera.cx += 9;
  camera.cy -= 6;
  camera.k1 = -0.06;
  camera.k2 = 0.02;
  const Pose tilted = moved({camera.camera_from_rig_rotation, camera.camera_from_rig_translation_mm},
                            {0.02, -0.015, 0.01}, {1, 2, 0});
  camera.camera_from_rig_rotation = tilted.rotation;
  camera.camera_from_rig_translation_mm = tilted.translation_mm;
}

std::vector<Pose> poses_of(const BoardRig& rig, int seed) {
  Random random(static_cast<std::uint64_t>(seed));
  std::vector<Pose> poses = {{Pose().rotation, {0, 0, rig.thickness_mm}}};
  for (int i = 1; i < rig.boards; ++i) {
    const double tilt = radians(rig.tilts_deg[static_cast<std::size_t>(i) % rig.tilts_deg.size()]);
    const double side = 2.399963 * i;  // golden angle: tilts go to all sides
    const double turn = radians(20 * random.uniform() - 10);
    const Mat3 rotation = calibration::product(rotation_of({tilt * std::cos(side), tilt * std::sin(side), 0}),
                                               rotation_of({0, 0, turn}));
    poses.push_back(
        {rotation, {30 * random.uniform() - 15, 20 * random.uniform() - 10, 40 * random.uniform()}});
  }
  return poses;
}

std::vector<BoardView> views_of(const BoardRig& rig, double sigma_px, int seed) {
  return views_of(rig, poses_of(rig, seed), sigma_px, seed);
}

std::vector<BoardView> views_of(const BoardRig& rig, const std::vector<Pose>& poses, double sigma_px,
                                int seed) {
  Random random(static_cast<std::uint64_t>(seed) + 1000);
  std::vector<BoardView> views;
  for (const Pose& pose : poses) {
    BoardView view = {"board" + std::to_string(views.size()), {}};
    for (int j = 5; j >= -5; --j) {
      for (int i = -8; i <= 8; ++i) {
        const double u = i * rig.square_mm, v = j * rig.square_mm;
        const Vec3 p = project(rig.camera, pose({u, v, 0}));
        view.corners.push_back({u, v, {p.x + sigma_px * random.normal(), p.y + sigma_px * random.normal()}});
      }
    }
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace weft::test
