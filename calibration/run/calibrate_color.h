// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "calibration/run/calibrate_outcome.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::calibration {

struct CalibrateColorOptions {
  std::filesystem::path input;   ///< photographs or sessions of a 24-patch chart, or one of them
  std::filesystem::path from;    ///< the calibration to change; empty: none
  std::filesystem::path output;  ///< the new one; must not be there
  std::string rig;               ///< its name where there is no `from`; empty: the input folder's
  /// x and y of the outer corners of patches 1, 6, 24 and 19, in pixels of the photograph or of the session's
  /// frames; empty: the chart is looked for.
  std::vector<double> corners_px = {};
  bool curve = false;  ///< affine, cubic, affine in xyY in place of the matrix
};
void describe(Fields& fields, CalibrateColorOptions& options);

/// Fits what makes linear Rec.709 of the camera's channels and writes a calibration with color.json and
/// report/color.html. Pictures are white balanced on the chart's greys, for the white balance of scans is
/// that of their lights. Photographs may be lit from one side; sessions are solved. Several pictures are
/// averaged. Of sessions, what the greys are off by is put into the lights of `from`, and where nobody had
/// measured a reflectance, the scale of albedo, too, which is absolute then.
///
/// Errors: as read_chart_picture() and read_chart_colors(); kBadData: no chart, or one that is mirrored,
/// upside down against named corners, in the shadow of something, or with more than six patches full or
/// unusable; a photograph of another body or aperture than `from`.
Result<CalibrateOutcome> calibrate_color(const CalibrateColorOptions& options, const JobContext& context);

}  // namespace weft::calibration
