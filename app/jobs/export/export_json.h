// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/jobs/export/encode_files.h"
#include "app/jobs/export/map_folder.h"
#include "app/jobs/export/plan.h"
#include "core/json_document.h"

namespace weft::app {

/// A document as it was written.
struct WrittenDocument {
  std::string name;
  std::string kind;
  std::string sha256;
  std::uint64_t bytes = 0;
  std::vector<std::string> files = {};     ///< that it names or holds
  std::vector<std::string> left_out = {};  ///< what its format cannot hold
};

/// The farthest level of `lost.by_distance` that people are told of: 8 times as far.
inline constexpr int kToldDistance = 3;

/// export.json (weft.export/1, docs/formats.md).
Json export_document(const PlannedExport& plan, const MapFolder& folder, const Json& provenance,
                     const std::vector<EncodedFile>& files, const std::vector<WrittenDocument>& documents);

/// What a file lost: {"normal_deg": {...}, "albedo": {...}}; empty where nothing of the kind is in it.
Json json_of(const exchange::Loss& loss);

}  // namespace weft::app
