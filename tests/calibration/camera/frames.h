// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "calibration/camera/pose.h"
#include "core/image/raw_frame.h"
#include "core/rig/camera.h"
#include "simulator/scene/scene.h"

namespace weft::test {

/// A camera of 640 x 420 pixels with a lens, tilted by 2 degrees, above a dark table without anything on it,
/// lit by one LED; blur, distortion and noise run.
simulator::Scene board_scene();

/// The raw photograph of a scene under its first LED, by way of a DNG.
RawFrame photographed(const simulator::Scene& scene);

/// The camera of a scene, exactly.
CameraModel camera_of(const simulator::Scene& scene);

/// Where a place (u, v) of a target is seen, exactly.
calibration::PixelPoint seen_at(const simulator::Scene& scene, std::size_t target, double u_mm, double v_mm);

/// The pose of a target in the rig frame, exactly.
calibration::Pose pose_of(const simulator::TargetSettings& target);

/// Mean and rms of differences along x and y.
struct Offsets {
  double mean_x = 0, mean_y = 0, rms = 0, farthest = 0;
};
Offsets offsets_of(const std::vector<calibration::PixelPoint>& differences);

}  // namespace weft::test
