// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/product.h"
#include "core/base/result.h"
#include "material/assets/compose.h"
#include "material/assets/material_place.h"
#include "material/assets/tree.h"

namespace weft::material {

/// A folder of its own, BUILD/<id>/, complete or not there.
inline constexpr ProductKind kMaterialProduct = {"weft.material-build", "material.json", "built material",
                                                 "build it first with weft material build"};

struct BuildOptions {
  std::vector<MaterialPlace> materials;
  std::filesystem::path output = {};  ///< holds all that is built; empty: build/ beside each material
  ComposeOptions compose = {};
};

struct BuiltMaterial {
  MaterialPlace place;
  std::string id;
  std::filesystem::path folder;
  bool was_there = false;
  Json document;  ///< material.json, with what is stale of its scans today
};

struct BuildReport {
  std::vector<BuiltMaterial> materials;      ///< those that were asked for, in their order
  int built = 0, kept = 0;                   ///< of the materials and all that they lie on
  int hashed = 0;                            ///< files that were read to know whether they changed
  std::vector<std::filesystem::path> files;  ///< that a change of would build something
};

/// Builds the materials and those of their layers, each once: what is there with the same id is kept,
/// whatever the times of files are. Errors of plan_materials(), before anything is written, and of
/// compose_material(); kUsage for a material of weft's own without an output; kInputOutput for a full disk.
Result<BuildReport> build_materials(const BuildOptions& options, const JobContext& context);

/// Where a material is built unless an output is named; empty for one of weft's own.
std::filesystem::path build_folder_of(const MaterialPlace& place);

}  // namespace weft::material
