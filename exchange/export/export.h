// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job.h"
#include "core/base/result.h"
#include "exchange/export/map_folder.h"
#include "exchange/presets/export_facts.h"
#include "exchange/presets/preset.h"

namespace weft::app {

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
  std::optional<double> to_deg = {};         ///< normals lose at most this in the mean: chooses their bits
};

/// What an export of one preset left behind.
struct ExportReport {
  std::filesystem::path folder;
  bool was_there = false;                ///< a complete one of the same maps, preset and options was found
  ExportFacts facts = {};                ///< as export.json has them
  std::vector<std::string> source = {};  ///< which solve it is of, and what is stale of that today
  double seconds = 0;                    ///< 0 where it was there
};

/// Packs the maps for each preset, writes its files and documents, measures what they lose by reading them
/// back, and publishes each folder whole, with export.json (weft.export/1, docs/formats.md). Files that are
/// alike in several presets are encoded once. An earlier export in the same place is replaced; anything else
/// there is refused. Everything that can be refused is refused before a file is made.
///
/// Errors: those of open_map_folder() and read_preset(); kBadData where a preset asks for what the maps lack,
/// names do not fit a disk, or a size is above the maps'; kCannotCreate where the output holds
/// something else; kInputOutput; kInterrupted.
Result<std::vector<ExportReport>> export_maps(const ExportOptions& options, const JobContext& context);

}  // namespace weft::app
