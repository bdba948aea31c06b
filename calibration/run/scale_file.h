// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "calibration/color/chart.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

// What people write beside photographs of a grey scale: scale.toml.

namespace weft::calibration {

/// A grey scale: what its patches reflect, and where it lies.
struct ScaleSettings {
  std::vector<double> reflectances = {};  ///< from the first patch to the last
  std::optional<ChartCorners> corners_px = {};
  double height_mm = 0;             ///< of the patches above the table
  double reflectance_sigma = 0.01;  ///< relative, of each patch by itself
  double delta = 0;                 ///< it reflects 1 - delta (1 - cosine) of Lambert's law
};

void describe(Fields& fields, ScaleSettings& settings);

/// Without a file, or without reflectances in it, those of Munsell's neutral scale. kBadData names what is
/// wrong.
Result<ScaleSettings> read_scale_file(const std::filesystem::path& file);

}  // namespace weft::calibration
