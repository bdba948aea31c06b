// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "material/assets/material_file.h"
#include "material/layers/field.h"
#include "material/layers/parameters.h"

// Maps that materials take from: those of a scan, of a built material, or single files.

namespace weft::material {

/// A folder of maps of one size: of a session or a solve of photographs the set that set_to_use() says, with
/// a height where one of them has it, a set (maps.json) or a built material (material.json).
struct MapSet {
  std::filesystem::path folder;
  Json document;
  Size size;
  std::optional<std::array<double, 2>> size_mm = {};
  bool is_size_known = true;  ///< else it is assumed
  bool is_tile = false;
  bool is_albedo_relative = false;      ///< its albedo lacks one factor
  Json provenance = Json::object();     ///< ids back to the photographs, level of the solve, whether a draft
  std::vector<std::string> stale = {};  ///< why it is not what would be made today, a sentence each
};
/// kNoInput where there is no set; kUsage for one of a preview unless `draft` asks for it; kBadData.
Result<MapSet> open_map_set(const std::filesystem::path& scan, bool draft);

/// Its solve for people and programs: "session", "maps", "solve", "level" and, where it is so, "draft" and
/// "stale"; null where nobody knows of a solve.
Json source_of(const MapSet& set);

/// Where a parameter's numbers lie, and how they become the parameter.
struct MapFile {
  std::filesystem::path file = {};
  std::vector<std::string> channels = {};  ///< empty: the first ones of the file
  bool is_lobe = false;                    ///< roughness.exr: alpha, alpha_along, yarn_deg
  std::string unit = {};                   ///< of the numbers, where it must be converted
  std::string source = "assumed";          ///< measured, derived or assumed
  std::optional<double> scale = {}, offset = {};
  bool y_is_down = false;
  /// None: colours are what transfer_of() of linear_image.h says of the file.
  std::optional<bool> is_srgb = {};
  std::optional<std::vector<double>> same = {};  ///< the whole map is this
  Size size = {};
  std::optional<std::array<double, 2>> size_mm = {};
  bool is_size_known = true;  ///< else it is assumed
  bool is_tile = true;
  bool is_of_scan = false;
  Json provenance = Json::object();
  std::vector<std::string> stale = {};  ///< of the scan's set
};

/// The map that a value of a parameter names, {"map", "scan", ...} in its one form; its numbers are not read.
/// A file's numbers are what its meaning (material/read/file_meaning.h) says unless the value does. `where`
/// is for messages. kNoInput; kBadData with the nearest map that the scan has, for a unit that is another's,
/// for a relative albedo without a scale, for a file that an export.json lists as something else, and for
/// heights in integers of which nobody says the millimetres.
Result<MapFile> find_map(Parameter parameter, const Json& value, const std::string& where);
/// Likewise of a mask or of weights.
Result<MapFile> find_mask(const Json& value, const std::string& where);

/// Its numbers as a field: slopes of a normal, roughness of any scale. Integer files hold n / 2 + 1/2 of a
/// normal unless a scale is said, and so do floats that show it (are_packed_normals()). kBadData with the
/// first pixel that is no number or out of the parameter's range (an albedo from -1 to 4), and for channels
/// that are not there.
Result<ParameterField> read_field(Parameter parameter, const MapFile& map, const std::string& where);
/// One plane, scaled as it says; `channel` counts from 0 where the map names none.
Result<ParameterField> read_mask(const MapFile& map, std::size_t channel, const std::string& where);

/// A parameter of a built material, not of the kind kFactor. Errors as of read_field().
Result<ParameterField> read_built(const MapSet& built, Parameter parameter);

/// What a scan at the top of a file stands for: [surface] values of all maps that are measured or derived,
/// and size_mm, where the file itself does not say them.
Result<void> expand_scan(MaterialFile& file);

}  // namespace weft::material
