// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "exchange/export/export_request.h"
#include "exchange/presets/export_facts.h"

namespace weft::exchange {

/// The farthest level of `lost.by_distance` that people are told of: 8 times as far.
inline constexpr int kToldDistance = 3;

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

}  // namespace weft::exchange
