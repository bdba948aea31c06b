// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "calibration/run/board_photographs.h"
#include "calibration/run/calibrate_outcome.h"
#include "calibration/run/poses_price.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::calibration {

struct CalibrateCameraOptions {
  /// Folder of photographs of one board; those named table... show it on the table.
  std::filesystem::path input;
  std::filesystem::path from;    ///< calibration whose other parts are copied; empty: none
  std::filesystem::path output;  ///< the new calibration, which must not be there yet; empty: none is written
  std::string rig;               ///< name of the rig; empty: that of `from`, or the input folder's
  BoardSettings board;           ///< overrides board.toml in the input folder
  std::string tag_dictionary = "DICT_APRILTAG_36h11";  ///< of the tags on the table
  double most_blur_px = 5;  ///< width of an edge above which a photograph is blurred; 1 to 100
  int least_boards = 5;     ///< photographs that must be usable; 3 to 1000
  /// Predicted sigma of the focal length above which boards are too alike; 0.001 to 10.
  double most_focal_percent = 0.3;
  PosesWish wish = {};
};
void describe(Fields& fields, CalibrateCameraOptions& options);

/// Measures lens and pose of the camera from photographs of a checkerboard or ChArUco board and writes a
/// calibration: camera.json with its covariance and the tags that the photographs of the table show, and
/// report/camera.html and .json. Photographs that cannot be used are left out and named in the warnings.
///
/// Errors: as read_board_file(), read_board_photographs() and fit_lens(); kBadData where no photograph of the
/// table can be used; kCannotCreate where `output` is there. Then nothing is written.
Result<CalibrateOutcome> calibrate_camera(const CalibrateCameraOptions& options, const JobContext& context);

/// What these photographs let that calibration know, and what more of them would (kMorePoses): by the light
/// of a LED as far away as the camera a place that is off turns the normal. Nothing is written. Errors: as
/// calibrate_camera() before it writes, and choose_poses().
Result<PosesPrices> price_camera(const CalibrateCameraOptions& options, const JobContext& context);

}  // namespace weft::calibration
