// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct SpeedOptions {
  double megapixels = 4;
  int threads = 0;  ///< 0: all the machine has
};

/// Time of the solver in memory, next to two yardsticks of the same run and the same threads:
///   copy    C: memcpy that reads and writes as many bytes in all as the bare kernel does
///   unpack  U: LibRaw's open and unpack of the eleven frames as DNG files
/// and the rows bare, fast, least-squares and seed (on fewer pixels: it takes as long a pixel).
/// `standard` also with the channels .model of sigma, which a solve of a session writes.
/// `ratio_to_copy` is against a copy of the bytes that the row itself moves, `ratio_to_unpack` against U.
Result<Rows> solve_speed(const SpeedOptions& options);

}  // namespace weft::bench
