// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct ScanBesideOptions {
  std::filesystem::path programs;  ///< where weft, weft-camera and weft-virtual-rig are
  std::filesystem::path scene = "testdata/scenes/satin.toml";
  double megapixels = 1;
  int turns = 10;  ///< pairs of scans
  int malformed = 1000, silent = 64, slow = 32;
  int viewers = 0;         ///< in place of these: clients that look at tiles of a solve of 16 megapixels
  std::uint64_t seed = 1;  ///< of what is malformed
  std::function<void(int done, int turns)> progress = [](int, int) {};
};

/// What clients cost a scan: in turn one alone, and one beside those who mean ill (malformed requests one
/// after another, silent clients, slow readers; crowd.h) or beside viewers, each asking for one tile after
/// another. One row: "turns", "alone_s" and "beside_s" (median), "ratio" (median of the pairs), "median_ms"
/// and "most_ms" of GET /api/v1/rig every 50 ms beside them.
/// Errors: of the rig's and the daemon's start, and of a scan.
Result<Rows> scan_beside_table(const ScanBesideOptions& options);

}  // namespace weft::bench
