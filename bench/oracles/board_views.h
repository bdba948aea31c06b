// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "calibration/camera/lens_fit.h"
#include "core/rig/camera.h"

namespace weft::test {

/// A camera 600 mm above a table that sees 200 mm across, and a board of 17 x 11 corners in many poses: the
/// first lies on the table, the others are turned, shifted, and tilted to all sides by these angles in turn.
struct BoardRig {
  BoardRig();

  CameraModel camera;  ///< the rig frame is that of the board on the table
  double square_mm = 9;
  double thickness_mm = 2;
  int boards = 15;
  std::vector<double> tilts_deg = {25, 35, 45};
};

/// Exact poses of the boards; the seed moves them a little.
std::vector<calibration::Pose> poses_of(const BoardRig& rig, int seed);

/// What the camera sees of boards, with normal noise along x and along y.
std::vector<calibration::BoardView> views_of(const BoardRig& rig, const std::vector<calibration::Pose>& poses,
                                             double sigma_px, int seed);
/// The same of poses_of(rig, seed).
std::vector<calibration::BoardView> views_of(const BoardRig& rig, double sigma_px, int seed);

}  // namespace weft::test
