// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "exchange/export/map_folder.h"
#include "exchange/export/prepare.h"
#include "exchange/presets/export_facts.h"

namespace weft::exchange {

/// Where the textures of one preset go.
struct EncodeTarget {
  const FilledPreset* preset = nullptr;
  std::filesystem::path folder;
};

struct EncodedTextures {
  /// In the order of the preset, without what needs more than one of them: channels' `source`, and `inside`.
  std::vector<ExportedTexture> textures;
  double seconds = 0;  ///< to pack, encode and write those that are no copies of another preset's
};

/// Writes the textures of all presets, those that are alike once, reads each back and measures what it lost.
/// Maps are read once where the memory allows, else file by file. One a target.
/// Errors: of MapPlanes, of write_texture(); kInterrupted.
Result<std::vector<EncodedTextures>> encode_files(const MapFolder& folder,
                                                  const std::vector<EncodeTarget>& targets, bool is_dx10,
                                                  const JobContext& context);

}  // namespace weft::exchange
