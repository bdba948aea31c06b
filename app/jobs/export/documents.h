// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "app/jobs/export/encode_files.h"
#include "app/jobs/export/export_json.h"
#include "app/jobs/export/map_folder.h"
#include "app/jobs/export/plan.h"
#include "core/base/result.h"

namespace weft::app {

/// Writes the documents of a plan, but for `layers` (write_layers()), beside its textures, which are in
/// `folder` already. Errors of the writers (exchange/gltf, materialx, usd, u3m), with the preset and the
/// document as `where`.
Result<std::vector<WrittenDocument>> write_documents(const PlannedExport& plan, const MapFolder& maps,
                                                     const std::vector<EncodedFile>& files,
                                                     const std::filesystem::path& folder);

}  // namespace weft::app
