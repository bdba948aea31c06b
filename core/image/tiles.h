// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stop_token>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"

namespace weft {

struct TileOptions {
  /// Columns a tile, rounded up to a whole row group, so that only the last tile of a row ends inside one.
  int width = 512;
  /// Rows a tile.
  int height = 32;
  /// Threads, 0 for all the machine has.
  int threads = 0;
};

/// The tiles of `area`, row by row; `area.x0` must be a multiple of kRowGroup.
std::vector<Rect> tiles_of(Rect area, const TileOptions& options);

/// The one tile loop: body(tile, worker) for every tile of `area`, in parallel and in no particular order.
/// Outputs depend only on absolute pixel positions, so neither tile size nor threads change a byte.
/// Returns kInterrupted, with the tiles begun finished, once `stop` is requested.
Result<void> for_each_tile(Rect area, const TileOptions& options, std::stop_token stop,
                           const std::function<void(Rect tile, int worker)>& body);

}  // namespace weft
