// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "calibration/camera/pose.h"
#include "calibration/lights/sheet.h"
#include "core/image/raw_frame.h"
#include "core/rig/camera.h"

namespace weft::calibration {

/// Where one photograph of a sheet departs from light that changes slowly over it: a fold is brighter under
/// one LED and darker under another, a stain is darker under all.
struct PaperUnevenness {
  int squares = 0;       ///< that depart, three at least
  double departure = 0;  ///< of the worst: its reading over what it should be, less 1
  PixelPoint at;         ///< its middle
};

/// Green readings of squares that show nothing but paper, a sixtieth of the frame wide, against a surface of
/// third order through their logarithms, fitted by least squares to those that are near it. A square departs
/// by 3 percent or more. Nothing where the paper is even, or where fewer than a hundred squares show it. No
/// calibration of lights is needed. `frame` has counts; black is taken off.
std::optional<PaperUnevenness> find_unevenness(const RawFrame& frame, const CameraModel& camera,
                                               const Sheet& sheet, const Pose& rig_from_sheet);

}  // namespace weft::calibration
