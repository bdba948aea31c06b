// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/image/compression.h"
#include "material/assets/map_set.h"
#include "material/assets/tree.h"

namespace weft::material {

struct ComposeOptions {
  Compression compression = Compression::kNone;
  bool has_pictures = true;
};

/// Composes a material into `folder` (docs/materials.md, "What is built"): its maps, their mips and pictures.
/// Gives material.json (weft.material-build/1) without writing it. `layers`: the built material of each
/// layer. A parameter at a time, so that memory holds few of them. Errors of MaterialStack and of files;
/// kInterrupted.
Result<Json> compose_material(const MaterialNode& node, std::vector<MapSet> layers,
                              const std::filesystem::path& folder, const ComposeOptions& options,
                              const JobContext& context);

}  // namespace weft::material
