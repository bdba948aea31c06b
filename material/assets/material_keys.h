// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"
#include "material/layers/parameters.h"

namespace weft::material {

/// What a key of a material's file holds.
enum class MaterialHolds {
  kText,
  kFlag,
  kNumber,
  kNumbers,  ///< as many as `count`
  kWholes,   ///< likewise, whole ones
  kColour,   ///< 3 numbers
  kWord,     ///< one of `words`
  kNames,    ///< a list of names of parameters
  kFile,     ///< of a material
  kFolder,   ///< of a scan
  kMask,
  kMap,
  kTable,  ///< read by itself
  kTexts
};

struct MaterialKey {
  const char* name;
  MaterialHolds holds;
  double least = 0, most = 0;
  int count = 1;
  std::vector<std::string> words = {};
};

std::span<const MaterialKey> top_keys();
std::span<const MaterialKey> layer_keys();
std::span<const MaterialKey> runtime_keys();
std::span<const MaterialKey> runtime_layer_keys();

/// The file that something is written in, for messages and relative names.
struct WrittenIn {
  std::string where;             ///< "dust.toml: [surface]"
  std::filesystem::path folder;  ///< empty: shipped
};

/// kBadData at "where: key".
Error unfit_material(const WrittenIn& in, const std::string& key, std::string why);

/// The key of this name. kBadData with the nearest that there is.
Result<const MaterialKey*> known_key(const std::string& name, std::span<const MaterialKey> known,
                                     const WrittenIn& in);

/// The value in its one form. kBadData.
Result<Json> value_of_key(const MaterialKey& key, const Json& value, const WrittenIn& in);
/// Likewise of a parameter: numbers or a map.
Result<Json> value_of_parameter(Parameter parameter, const Json& value, const WrittenIn& in);

}  // namespace weft::material
