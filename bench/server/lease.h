// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct ServerLeaseOptions {
  std::filesystem::path programs;  ///< where weft, weft-camera and weft-virtual-rig are
  std::filesystem::path scene = "testdata/scenes/satin.toml";
  int trials = 100;        ///< of each death
  std::uint64_t seed = 1;  ///< of the moments
  std::function<void(int done, int trials)> progress = [](int, int) {};
};

/// How long a LED stays lit once nobody holds it, told by the pins of a virtual board. A client lights a LED
/// through weft serve, renews it every half second, and at a random moment falls silent, or the daemon is
/// killed (SIGKILL). A row a death: "death" (client, daemon), "trials", "median_s", "worst_s", "late" (trials
/// that were not dark after 2 s). Errors: of the rig's and the daemon's start, and of a light that is
/// refused.
Result<Rows> server_lease_table(const ServerLeaseOptions& options);

}  // namespace weft::bench
