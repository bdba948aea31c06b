// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/camera/markers.h"
#include "calibration/lights/sheet.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

// What people write about a sheet of white paper.

namespace weft::calibration {

/// Where these files are described.
inline constexpr const char* kCalibrationPage = "docs/calibration.md";

/// A sheet with tags printed in its border.
struct TaggedSheet {
  Sheet sheet;  ///< its printed squares are the tags with their quiet zone
  std::vector<SheetTag> tags;
  std::optional<double> delta;  ///< it reflects 1 - delta (1 - cosine) of Lambert's law; absent: nobody knows
};

/// What sheet.toml says.
struct SheetDescription {
  struct Tag {
    std::string dictionary = "DICT_APRILTAG_36h11";
    int id = 0;
    double side_mm = 0;
    std::vector<double> centre_mm;
  };
  double width_mm = 0, height_mm = 0, margin_mm = 5;
  std::vector<double> reflectance;  ///< one number or three; none: nobody measured it
  std::optional<double> delta;
  std::vector<Tag> tags;
};
void describe(Fields& fields, SheetDescription::Tag& tag);
void describe(Fields& fields, SheetDescription& sheet);

/// sheet.toml: width_mm and height_mm (to 10000), margin_mm (default 5), reflectance (0 to 1, one number or
/// three; absent where nobody measured it), delta (-0.5 to 1; absent where nobody measured it), and for each
/// tag a [[tag]] of dictionary (default DICT_APRILTAG_36h11), id, side_mm with its black border, centre_mm =
/// [u, v] from the sheet's centre. kBadData names the key that is unknown, missing or wrong.
Result<TaggedSheet> read_sheet_file(const std::filesystem::path& file);

}  // namespace weft::calibration
