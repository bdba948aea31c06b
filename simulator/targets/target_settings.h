// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/base/vec.h"

// What lies on the table for calibration, beside the cloth or instead of it.

namespace weft::simulator {

/// A blank sheet, or as a small one a white patch.
struct PaperSettings {
  double width_mm = 297;  ///< 0.1 to 10000, as all sizes without a range
  double height_mm = 210;

  bool operator==(const PaperSettings&) const = default;
};

/// The square at the upper left corner is black.
struct CheckerboardSettings {
  int squares_x = 10;  ///< 1 to 100
  int squares_y = 7;
  double square_mm = 15;
  double margin_mm = 15;  ///< white, around the squares; 0 to 1000

  bool operator==(const CheckerboardSettings&) const = default;
};

/// cv::aruco::CharucoBoard of OpenCV 4.6: the square at the upper left corner is black, markers are numbered
/// from 0 in the white squares, row by row from the top.
struct CharucoSettings {
  int squares_x = 7;  ///< 2 to 100, no more than the dictionary has markers for
  int squares_y = 5;
  double square_mm = 20;
  double marker_share = 0.75;               ///< side of a marker over that of a square; 0.1 to 0.95
  std::string dictionary = "DICT_5X5_100";  ///< as OpenCV names it
  double margin_mm = 10;                    ///< white; 0 to 1000
  bool mirrored = false;                    ///< printed as a mirror shows it

  bool operator==(const CharucoSettings&) const = default;
};

/// A row of patches on a white card.
struct GreyScaleSettings {
  /// From left to right, 1 to 100 of them, each 0 to 1. The default is the neutral scale of Munsell: values
  /// 9.5 and 9 to 2 by ASTM D1535.
  std::vector<double> reflectances = {0.878, 0.767, 0.576, 0.420, 0.293, 0.193, 0.117, 0.064, 0.030};
  double patch_mm = 20;
  double gap_mm = 2;     ///< between patches; 0 to 1000
  double margin_mm = 5;  ///< 0 to 1000

  bool operator==(const GreyScaleSettings&) const = default;
};

/// The classic chart: 6 x 4 patches in a black frame, number 1 (dark skin) at the upper left, 19 to 24 from
/// white to black along the bottom.
struct ChartSettings {
  double patch_mm = 25;
  double gap_mm = 2.5;  ///< between patches; 0 to 1000
  double frame_mm = 5;  ///< around all of them; 0 to 1000

  bool operator==(const ChartSettings&) const = default;
};

/// One ArUco or AprilTag marker.
struct TagSettings {
  std::string dictionary = "DICT_APRILTAG_36h11";  ///< as OpenCV names it
  int id = 0;                                      ///< from 0, below what the dictionary holds
  double side_mm = 15;                             ///< with its black border
  double margin_mm = 4;                            ///< white; 0 to 1000

  bool operator==(const TagSettings&) const = default;
};

/// In the order of the alternatives of PatternSettings.
enum class TargetKind { kPaper, kCheckerboard, kCharuco, kGreyScale, kChart, kTag };
using PatternSettings = std::variant<PaperSettings, CheckerboardSettings, CharucoSettings, GreyScaleSettings,
                                     ChartSettings, TagSettings>;

inline TargetKind kind_of(const PatternSettings& pattern) {
  return static_cast<TargetKind>(pattern.index());
}

/// What the pattern is printed on.
struct SheetSettings {
  double waviness_deg = 0;    ///< rms angle of its slow waves to the plane; 0 to 10
  double wavelength_mm = 80;  ///< about, of the waves; 1 to 10000
  double grain_percent = 0;   ///< rms of the albedo of a grain over its mean; 0 to 20
  double grain_deg = 0;       ///< rms angle of a grain to the sheet; 0 to 20
  double grain_mm = 0.1;      ///< side of a grain; 0.01 to 10
  /// delta of f_p = 1 - delta (1 - n . l), what the sheet reflects over Lambert's law; -0.5 to 1
  double non_lambertian = 0;

  bool operator==(const SheetSettings&) const = default;
};

/// A sheet on the table, and what is printed on it.
struct TargetSettings {
  PatternSettings pattern;
  Vec3 centre_mm;           ///< of the sheet in the rig frame; -10000 to 10000
  double tilt_deg = 0;      ///< between its normal and z; 0 to 85
  double azimuth_deg = 0;   ///< of its normal's horizontal part, from x towards y; -360 to 360
  double rotation_deg = 0;  ///< in its plane, counterclockwise seen from its front; -360 to 360
  double white = 0.9;       ///< reflectance of the sheet; 0 to 1
  double black = 0.04;      ///< of black ink; 0 to 1
  SheetSettings sheet;

  bool operator==(const TargetSettings&) const = default;
};

}  // namespace weft::simulator
