// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/tag_cards.h"

#include <utility>

#include "core/base/files.h"
#include "core/rig/camera.h"

namespace weft::calibration {

std::vector<WhitePatch> patches_of_cards(const Calibration& calibration, const WhitePatch& common) {
  std::vector<WhitePatch> patches;
  const CameraModel& camera = *calibration.camera;
  for (const Fiducial& tag : calibration.fiducials) {
    const Vec3 centre =
        0.25 * (tag.corners_mm[0] + tag.corners_mm[1] + tag.corners_mm[2] + tag.corners_mm[3]);
    // As long as its side.
    const Vec3 right = 0.5 * (tag.corners_mm[1] - tag.corners_mm[0] + tag.corners_mm[2] - tag.corners_mm[3]),
               up = 0.5 * (tag.corners_mm[0] - tag.corners_mm[3] + tag.corners_mm[1] - tag.corners_mm[2]);
    const double side = tag.id % 2 == 0 ? 1 : -1, near = 0.5 + kCardQuiet, far = near + kCardWhite;
    WhitePatch patch = common;
    for (const auto& [u, v] : {std::pair{near, near}, {far, near}, {far, -near}, {near, -near}}) {
      const Vec3 p = project(camera, centre + (side * u) * right + v * up);
      const bool is_seen =
          p.z > 0 && p.x >= 0 && p.y >= 0 && p.x <= camera.size.width - 1 && p.y <= camera.size.height - 1;
      if (is_seen) patch.polygon_px.push_back({p.x, p.y});
    }
    if (patch.polygon_px.size() == 4) patches.push_back(std::move(patch));
  }
  return patches;
}

bool has_cards(const std::filesystem::path& session) {
  constexpr int kMostAbove = 3;
  std::filesystem::path folder = absolute_folder(session);
  for (int above = 0; above < kMostAbove; ++above) {
    folder = folder.parent_path();
    if (is_there(folder / kTargetsFolder / kCardsFile)) return true;
  }
  return false;
}

}  // namespace weft::calibration
