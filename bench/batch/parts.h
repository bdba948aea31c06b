// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "bench/base/report.h"
#include "core/result.h"

// What `weft bench batch` measures, and the table of it.

namespace weft::bench {

struct BatchBenchOptions {
  std::filesystem::path scene = "testdata/scenes/twill.toml";  ///< from where the program runs
  int sessions = 0;                                            ///< 0: as the part has it
  double megapixels = 0;                                       ///< of a session; 0: as the part has it
  int jobs = 1;                                                ///< sessions at a time
  int kills = 100;
  int threads = 0;  ///< 0: all the machine has
};

struct BatchPart {
  const char* name;
  const char* what;
  Result<Rows> (*measure)(const BatchBenchOptions& options);
};

std::span<const BatchPart> batch_parts();

// A file each.

/// Wall seconds of `weft batch run` over so many sessions (200 of 1 megapixel) against one process that
/// solves them in turn with all threads, and against what the plan said.
Result<Rows> batch_local(const BatchBenchOptions& options);
/// Seconds of `weft batch plan` over 10 000 sessions, those of the sample apart.
Result<Rows> batch_plan(const BatchBenchOptions& options);
/// Seconds of `weft batch merge` over 10 000 results.
Result<Rows> batch_merge(const BatchBenchOptions& options);
/// `weft batch run` killed at random moments until all is done: what is published, half made and done twice.
Result<Rows> batch_kills(const BatchBenchOptions& options);
/// 40 sessions of 1 megapixel by three rigs of mixed bodies, one of whose calibrations has two LEDs in the
/// wrong place, by how far: what the report says of calibrations.
Result<Rows> batch_rigs(const BatchBenchOptions& options);
/// 200 small tasks here against their simulation, and simulations of a million sessions on 100 nodes.
Result<Rows> batch_farm(const BatchBenchOptions& options);

}  // namespace weft::bench
