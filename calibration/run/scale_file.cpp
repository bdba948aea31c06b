// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/scale_file.h"

#include <algorithm>
#include <utility>

#include "calibration/response/neutral_scale.h"
#include "calibration/run/sheet_files.h"
#include "core/base/files.h"
#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"

namespace weft::calibration {
namespace {

void describe_corners(Fields& fields, std::optional<ChartCorners>& corners) {
  Json list;
  fields.value(
      {"corners_px",
       "Outer corners of the row of patches, [[x, y], ...] clockwise from the first patch, on the active "
       "area"},
      list);
  if (list.is_null()) return;
  const auto rows = rows_of(list, 2);
  corners.emplace();
  const bool are_four = rows && rows->size() == corners->size();
  fields.require(are_four, "corners_px", "must be four corners, [[x, y], ...]");
  for (std::size_t i = 0; are_four && i < corners->size(); ++i)
    (*corners)[i] = {(*rows)[i][0], (*rows)[i][1]};
}

}  // namespace

void describe(Fields& fields, ScaleSettings& s) {
  fields.value({.name = "reflectances",
                .says = "Of each patch from the first to the last; default the neutral scale of Munsell",
                .range = {0, 1},
                .fewest = 5,
                .most = 100},
               s.reflectances);
  fields.require(std::ranges::find(s.reflectances, 0.0) == s.reflectances.end(), "reflectances",
                 "must be above 0 each");
  describe_corners(fields, s.corners_px);
  fields.value({"height_mm", "Of the patches above the table, mm", {-1000, 1000}}, s.height_mm);
  fields.value({"reflectance_sigma", "Of each patch by itself, relative", {1e-6, 1}}, s.reflectance_sigma);
  fields.value({"delta", "It reflects 1 - delta (1 - cosine) of Lambert's law", {-0.5, 1}}, s.delta);
}

Result<ScaleSettings> read_scale_file(const std::filesystem::path& file) {
  ScaleSettings settings;
  if (is_there(file)) {
    Result<ScaleSettings> said = read_file<ScaleSettings>(file, kCalibrationPage);
    if (!said) return said;
    settings = std::move(*said);
  }
  if (settings.reflectances.empty()) {
    for (const MunsellPatch& patch : munsell_scale()) settings.reflectances.push_back(patch.reflectance);
  }
  return settings;
}

}  // namespace weft::calibration
