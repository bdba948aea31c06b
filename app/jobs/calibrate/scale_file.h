// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "calibration/color/chart.h"
#include "core/result.h"

// What people write beside photographs of a grey scale: scale.toml.

namespace weft::app {

/// A grey scale: what its patches reflect, and where it lies.
struct ScaleSettings {
  std::vector<double> reflectances;  ///< from the first patch to the last
  std::optional<calibration::ChartCorners> corners_px;
  double height_mm = 0;             ///< of the patches above the table
  double reflectance_sigma = 0.01;  ///< relative, of each patch by itself
  double delta = 0;                 ///< it reflects 1 - delta (1 - cosine) of Lambert's law
};

/// Keys, all optional: `reflectances`, five or more, each above 0 and to 1 (default the neutral scale of
/// Munsell); `corners_px`, the outer corners of the row of patches, [[x, y], ...] clockwise from the first
/// patch, on the active area; `height_mm` (-1000 to 1000); `reflectance_sigma` (above 0, to 1); `delta`
/// (-0.5 to 1). A file that is not there has none. kBadData names what is wrong.
Result<ScaleSettings> read_scale_file(const std::filesystem::path& file);

}  // namespace weft::app
