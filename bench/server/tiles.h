// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct ServerTilesOptions {
  std::vector<int> megapixels = {16, 100};
  std::vector<int> clients = {2, 16};
  int tiles = 400;  ///< asked for by all clients together
  std::uint64_t seed = 1;
  std::function<void(int done, int steps)> progress = [](int, int) {};
};

/// What a viewer waits for, over HTTP, of maps that are written for it into a temporary folder: slopes that
/// no codec can guess. A row a question: "what", "megapixels", "clients", "median_ms", "p95_ms", "most_ms",
/// "asked_ms", "holds". "first view" is the topmost tile of normals and albedo of a solve that nobody has
/// looked at, "tiles" are of levels 0 to 2 anywhere, each client asking for one after another.
/// Errors: of writing the maps, of RigServer::start().
Result<Rows> server_tiles_table(const ServerTilesOptions& options);

}  // namespace weft::bench
