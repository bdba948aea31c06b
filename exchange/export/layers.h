// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/job.h"
#include "core/base/result.h"
#include "exchange/export/encode_files.h"
#include "exchange/export/export_json.h"
#include "exchange/export/map_folder.h"
#include "exchange/export/plan.h"

namespace weft::app {

/// What the layers of a built material left beside its own textures.
struct WrittenLayers {
  std::vector<EncodedFile> files;
  std::vector<WrittenDocument> documents;
};

/// The layers that a material mixes while it is drawn ([runtime], docs/materials.md): the preset's textures
/// of each in layers/NAME/, their weights where they are a map, NAME_layers.mtlx with a mix of surface
/// shaders, and `document` (weft.layers/1) for engines. `files` are the material's own textures, in `folder`
/// already. Errors of runtime_stack_of(), plan_preset(), encode_files() and materialx_mix_of().
Result<WrittenLayers> write_layers(const PlannedExport& plan, const PlannedDocument& document,
                                   const MapFolder& maps, const std::vector<EncodedFile>& files,
                                   const std::filesystem::path& folder, const JobContext& context);

}  // namespace weft::app
