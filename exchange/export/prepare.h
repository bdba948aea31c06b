// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/job.h"
#include "core/base/result.h"
#include "exchange/export/export.h"
#include "exchange/export/map_folder.h"
#include "exchange/export/plan.h"

namespace weft::app {

/// What is known of an export before its first file is made.
struct PreparedExport {
  ExportOptions options;  ///< `input` is a folder
  MapFolder folder;
  std::vector<PlannedExport> plans;  ///< one a preset, with the bits that `to_deg` asks for
};

/// Builds the material where the input is one, opens its folder and plans each preset. Errors of
/// build_materials() and export_maps().
Result<PreparedExport> prepare_export(const ExportOptions& asked, const JobContext& context);

}  // namespace weft::app
