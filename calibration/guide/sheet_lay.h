// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "calibration/camera/pose.h"
#include "calibration/lights/sheet.h"
#include "calibration/run/sheet_files.h"
#include "core/base/vec.h"
#include "core/rig/camera.h"

// How a white sheet lies by its tags, held against how a person was asked to lay it.

namespace weft::calibration {

/// In the rig frame.
struct SheetLay {
  Vec3 normal = {0, 0, 1};
  double turn_deg = 0;  ///< turn_deg() of its pose
  Vec3 centre_mm;
  double lowest_mm = 0;  ///< of its corners, above the table
};
SheetLay lay_of(const Pose& rig_from_sheet, const Sheet& sheet);

/// The least angle between two turns.
double between_deg(double a_deg, double b_deg);

/// What is asked. Sides are those of the picture, whatever way the rig frame is turned.
struct WantedLay {
  const char* name = "";    ///< what the names of its photographs begin with
  double tilt_deg = 0;      ///< 0: flat
  double azimuth_deg = 0;   ///< its normal leans to the right of the picture at 0, to its top at 90
  const char* raised = "";  ///< the edge that this raises, for people; empty: any will do
  const char* says = "";    ///< to the person
  double within_deg = 4;    ///< of the normal asked for; where any side will do, of the tilt
  double within_mm = 15;    ///< a flat one lies no higher above the table
  bool is_in_middle = false;
  bool is_turned = false;  ///< in its plane, to every flat one before
};

/// What is asked of a sheet, and what it is held against.
struct SheetAim {
  TaggedSheet sheet;
  CameraModel camera;  ///< as it was known before
  WantedLay wanted;
  std::vector<double> turns_deg;  ///< of flat sheets that this one is to be turned to
};

/// What is wrong and what to do: "the sheet lies flat: raise its left edge". Empty: it lies as was asked.
std::string departure_of(const SheetLay& lay, const SheetAim& aim);

/// Corners of the sheet as the camera would see it where it lies as was asked, in shares of the picture, from
/// its upper left. It is turned to the last of those before.
std::array<PixelPoint, 4> outline_of(const SheetAim& aim);
/// The same of a sheet as it lies.
std::array<PixelPoint, 4> outline_of(const Pose& rig_from_sheet, const Sheet& sheet,
                                     const CameraModel& camera);

}  // namespace weft::calibration
