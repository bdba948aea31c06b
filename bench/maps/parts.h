// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "bench/base/report.h"
#include "core/result.h"

// What `weft bench maps` measures: one part a map, each in a file of its own, and the table of them.

namespace weft::bench {

struct MapsBenchOptions {
  double megapixels = 0;  ///< 0: the size that docs/maps.md quotes
  int threads = 0;        ///< 0: all the machine has. Processor time is of all of them together
};

struct MapsPart {
  const char* name;
  const char* what;
  Result<Rows> (*measure)(const MapsBenchOptions& options);
};

/// All parts, in the order of docs/maps.md.
std::span<const MapsPart> maps_parts();

}  // namespace weft::bench
