// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace weft::material {

/// A material to begin with.
struct NewMaterial {
  std::filesystem::path file;
  std::string inherits;             ///< as in a file; empty: nothing
  std::filesystem::path scan;       ///< empty: none
  bool is_draft = false;            ///< maps of a preview will do
  bool is_albedo_relative = false;  ///< of the scan: a person has to say its scale
  std::vector<std::string> layers;  ///< materials to be laid on it, bottom to top
};

/// Its text, relative to its file where it can be. One of dirt goes into what is deep
/// of a scan.
std::string text_of(const NewMaterial& material);

/// Writes it. kCannotCreate where the file is there; kBadData and kNoInput where it could not be resolved,
/// then nothing is written; kInputOutput.
Result<void> write_new_material(const NewMaterial& material);

}  // namespace weft::material
