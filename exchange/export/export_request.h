// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/describe/fields.h"

namespace weft::exchange {

struct ExportOptions {
  /// A session, a set of maps, a built material, a solve, or a material that is built first: a file that ends
  /// in .toml, or library:NAME.
  std::filesystem::path input;
  std::string maps = {};                  ///< id of the set of a session; empty: set_to_use() says it
  bool is_draft = false;                  ///< maps of a preview will do
  std::vector<std::string> presets = {};  ///< names, or files that end in .toml
  /// Empty: SESSION/export/<preset>, of a folder elsewhere FOLDER/export/<preset>, of a material's file
  /// NAME-export/<preset> beside it. Of several presets each has a folder of its name in it.
  std::filesystem::path output = {};
  std::filesystem::path material_base = {};  ///< in place of the folder's own, of a material that was built
  std::string name = {};                     ///< of the cloth in file names; empty: as it is called
  std::optional<int> size_px = {};           ///< of the longer side; none: as the preset has it
  bool is_dx10 = false;                      ///< DDS with DX10 headers alone
  /// What a person says of a pixel of solved photographs, which solve::keep_pixel() keeps before.
  std::optional<double> mm_per_pixel = {};
  std::optional<double> to_deg = {};    ///< normals lose at most this in the mean: chooses their bits
  std::optional<double> within_s = {};  ///< of writing the textures by one thread: chooses them, too
};

/// What `weft export` and a job that exports are told.
struct ExportRequest {
  ExportOptions options;
  bool lists = false;
  std::string shown;  ///< a preset to print; empty: none
  bool only_explains = false;
};
void describe(Fields& fields, ExportRequest& request);

}  // namespace weft::exchange
