// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/result.h"
#include "exchange/export/encode_files.h"
#include "exchange/export/export_json.h"
#include "exchange/export/map_folder.h"
#include "exchange/export/plan.h"

namespace weft::app {

/// Writes the documents of a plan, but for `layers` (write_layers()), beside its textures, which are in
/// `folder` already. Errors of the writers (exchange/gltf, materialx, usd, u3m), with the preset and the
/// document as `where`.
Result<std::vector<WrittenDocument>> write_documents(const PlannedExport& plan, const MapFolder& maps,
                                                     const std::vector<EncodedFile>& files,
                                                     const std::filesystem::path& folder);

}  // namespace weft::app
