// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"

// What people wrote beside their photographs.

namespace weft::library {

/// Empty: nobody said.
struct ImportDescription {
  std::string fabric;
  std::optional<double> cloth_height_mm;
  std::optional<double> exposure_us, iso, f_number;  ///< of photographs that do not say theirs
  Json metadata = Json::object();                    ///< of library/catalogue/metadata.h

  /// What the other says takes the place of what this one says.
  void take(const ImportDescription& other);
};

/// Reads import.toml, or NAME.json with the same keys: fabric, cloth_height_mm, exposure_us, iso, f_number;
/// id (or barcode), tags, composition, construction, side, kind, notes, weight_g_m2, thickness_mm. kNoInput;
/// kBadData for what cannot be read, a key that is none of these, and a value that breaks its rule.
Result<ImportDescription> read_description(const std::filesystem::path& file);

/// Those of the files that speak of a session whose frames lie in `folder`, the nearest last: import.toml of
/// the folder and of those above it up to `root`, then FOLDER.json beside the folder and in it, then
/// NAME.json in it.
std::vector<std::filesystem::path> descriptions_of(const std::vector<std::filesystem::path>& files,
                                                   const std::filesystem::path& root,
                                                   const std::filesystem::path& folder,
                                                   const std::string& session);

}  // namespace weft::library
