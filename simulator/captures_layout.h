// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/rig/camera.h"
#include "simulator/scene/scene.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/targets/target_settings.h"

// What a rig is calibrated from and where it lies, sized by what its camera sees. Millimetres, rig frame.

namespace weft::simulator {

/// A square tag printed on a sheet, in the dictionary of TagSettings.
struct CaptureTag {
  int id = 0;
  std::array<double, 2> centre_mm = {};  ///< u to the right, v up from the sheet's centre
};

/// A sheet of white paper with tags in its border.
struct SheetLayout {
  double x_mm = 0, y_mm = 0;  ///< where its centre lies: in the middle of the picture
  double width_mm = 0, height_mm = 0;
  double margin_mm = 0;  ///< of the border that the tags take
  double tag_mm = 0;     ///< side of a tag with its black border
  std::vector<CaptureTag> tags;
};

/// How a sheet lies: its lowest corner `above_mm` over the table, turned in its plane first, then tilted.
struct CapturePose {
  double tilt_deg = 0;
  double azimuth_deg = 0;  ///< of its normal's horizontal part
  double rotation_deg = 0;
  double above_mm = 1;
};

/// Flat, and 20 degrees about x and about y, both ways.
std::vector<CapturePose> five_poses();

/// A thing that lies in this pose where its x and y are.
TargetSettings resting(TargetSettings thing, const CapturePose& pose);

/// The largest sheet of the frame's shape that lies whole in the frame in all of the poses. It has eight
/// tags: one at each corner and two along each long side, which are seen of a sheet that is turned by 90
/// degrees.
SheetLayout sheet_layout(const Scene& scene, const CameraModel& camera,
                         const std::vector<CapturePose>& poses);

/// The sheet and its tags as targets, the sheet of `paper`'s reflectance and surface. As waves and grain go
/// by a target's number, the sheet that comes first is another one than the sheet that comes last.
std::vector<TargetSettings> laid(const SheetLayout& sheet, const CapturePose& pose,
                                 const TargetSettings& paper, bool sheet_first = true);

/// A board of 18 x 12 squares (17 x 11 inner corners) over 55 percent of the frame's width; of fewer, down to
/// 6 x 4, where a square would have less than 32 pixels.
CharucoSettings board_pattern(const Scene& scene);

/// `count` boards up to 34 degrees from level, at various heights and turns, spread over the whole frame and
/// all of them inside it.
std::vector<TargetSettings> board_poses(const Scene& scene, const CameraModel& camera,
                                        const CharucoSettings& board, int count, std::int64_t seed);

/// What stays on the table: the scene's own tags and white patches, or where it has no tag one in each corner
/// of the frame.
std::vector<TargetSettings> furniture(const Scene& scene, const CameraModel& camera);

/// The exposure, in whole microseconds, that gives the brightest spot of these targets `share` of full scale
/// with all of these LEDs (from 1) lit at once.
double exposure_for(const Scene& scene, const SceneRig& rig, const std::vector<TargetSettings>& targets,
                    const std::vector<int>& leds, double share);

}  // namespace weft::simulator
