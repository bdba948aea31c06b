// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "bench/base/report.h"
#include "core/result.h"

// What `weft bench export` measures, a file each, and the table of them.

namespace weft::bench {

struct ExportBenchOptions {
  std::filesystem::path scene = "testdata/scenes/export_satin.toml";  ///< from where the program runs
  int threads = 0;                                                    ///< 0: all the machine has
};

struct ExportPart {
  const char* name;
  const char* what;
  Result<Rows> (*measure)(const ExportBenchOptions& options);
};

/// All parts, in the order of docs/exports.md.
std::span<const ExportPart> export_parts();

}  // namespace weft::bench
