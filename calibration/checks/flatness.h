// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "calibration/camera/pose.h"
#include "core/base/vec.h"
#include "core/rig/camera.h"
#include "core/rig/lights.h"

namespace weft::calibration {

// Whether a calibration makes a flat sheet flat and a tilted one as steep as it is: the test that no fit to
// the same sheet can fake. A sheet that light was fitted to comes out flat whatever the directions are
// (accuracy of slopes is another matter), so the evidence is another sheet, or the same one turned.

/// One square of the frame, all of it paper.
struct SheetSquare {
  int column = 0, row = 0;
  double x_px = 0, y_px = 0;                       ///< centre
  std::vector<std::array<double, 3>> reading_rgb;  ///< by LED; what is not a positive number is not used
};

struct SheetEvidence {
  int columns = 0, rows = 0;  ///< of squares in the frame
  Pose rig_from_sheet;        ///< by tags; its third axis is the normal
  double normal_sigma_deg = 0;
  std::optional<Vec3> known_normal = {};  ///< of a sheet on a wedge, in the place of the pose's
  double paper_delta = 0;                 ///< the paper reflects 1 - delta (1 - n . l) of Lambert's law
  std::vector<SheetSquare> squares;
};

/// From this tilt on a sheet tells of slopes.
inline constexpr double kTiltedFrom_deg = 5;

/// What the calibration makes of a sheet.
struct SheetCheck {
  std::vector<double> error_deg;  ///< row by row; NaN beside the sheet
  double rms_deg = 0;             ///< of error_deg
  double pattern_rms_deg = 0;     ///< about the mean normal of the squares
  double worst_deg = 0;
  int squares = 0;  ///< with a normal: three LEDs at least
  double tilt_deg = 0;
  double normal_sigma_deg = 0;  ///< of how the sheet lies
  /// Solved slopes of a tilted sheet over true ones along the true slope, and how well they are known.
  std::optional<double> slope_gain = {};
  double slope_gain_sigma = 0;
  std::array<double, 3> reflectance_rgb = {};  ///< mean solved albedo
};

/// Solves every square by weighted least squares, the light taken at the point of the sheet that the square
/// shows.
SheetCheck check_sheet(const CameraModel& camera, const NearLights& lights, const SheetEvidence& evidence);

/// A calibration is accepted within these.
struct CheckLimits {
  double flat_rms_deg = 0.15;    ///< of sheets that lie flat
  double tilted_rms_deg = 0.35;  ///< of tilted ones, beside what is unknown of how they lie
  double slope_gain = 0.01;      ///< off 1
  double drift = 0.01;           ///< of a LED that is lit once more at the end, relative
};

}  // namespace weft::calibration
