// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct EndToEndOptions {
  double megapixels = 16;
  int threads = 0;  ///< 0: all the machine has
  std::filesystem::path
      program;  ///< weft itself: the solve runs in a process of its own, so that its peak is its own
};

/// From eleven DNG files to maps on disk by `weft solve --quality fast`, next to LibRaw's unpacking of the
/// same files and OpenEXR's and libpng's writing of the same maps, with the same threads: `ratio` is decode
/// to write over their sum, without compression, syncing and hashing. Memory is the peak of the process.
Result<Rows> end_to_end(const EndToEndOptions& options);

}  // namespace weft::bench
