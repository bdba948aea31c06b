// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/json_document.h"
#include "exchange/export/encode_files.h"
#include "exchange/export/map_folder.h"
#include "exchange/export/plan.h"
#include "exchange/presets/export_facts.h"

namespace weft::app {

/// The farthest level of `lost.by_distance` that people are told of: 8 times as far.
inline constexpr int kToldDistance = 3;

ExportFacts export_facts(const PlannedExport& plan, const MapFolder& folder, const Json& provenance,
                         const std::vector<EncodedFile>& files,
                         const std::vector<WrittenDocument>& documents);
}  // namespace weft::app
