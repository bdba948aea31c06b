// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/job.h"
#include "core/base/result.h"
#include "exchange/export/map_folder.h"
#include "exchange/export/plan.h"
#include "exchange/presets/loss.h"

namespace weft::app {

/// A texture as it was written.
struct EncodedFile {
  exchange::PresetFile file;
  std::string name;  ///< relative to the folder of its export
  Size size;         ///< of its largest level, without padding
  int levels = 1;
  exchange::ChannelFacts facts = {};
  std::string sha256 = {};
  std::uint64_t bytes = 0;
  exchange::Loss loss = {};
  double seconds = 0;  ///< to pack, encode and write; 0 where it is a copy of another preset's
};

/// Where the textures of one plan go.
struct EncodeTarget {
  const PlannedExport* plan = nullptr;
  std::filesystem::path folder;
};

/// Writes the textures of all plans, those that are alike once, reads each back and measures what it lost.
/// A list a target, in the order of its plan. Maps are read once where the memory allows, else file by file.
/// Errors: of MapPlanes, of write_texture(); kInterrupted.
Result<std::vector<std::vector<EncodedFile>>> encode_files(const MapFolder& folder,
                                                           const std::vector<EncodeTarget>& targets,
                                                           bool is_dx10, const JobContext& context);

}  // namespace weft::app
