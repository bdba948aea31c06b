// SPDX-License-Identifier: Apache-2.0
#include "bench/base/libraw_alone.h"

#include <libraw/libraw.h>

#include <atomic>
#include <memory>

#include "bench/base/report.h"
#include "core/parallel.h"

namespace weft::bench {

Result<double> unpack_seconds(const std::vector<std::filesystem::path>& files, int threads) {
  std::atomic<int> failures = 0;
  const double seconds = least_seconds(3, [&] {
    parallel_for(files.size(), threads, [&](std::size_t i, int) {
      const auto raw = std::make_unique<LibRaw>();
      if (raw->open_file(files[i].c_str()) != LIBRAW_SUCCESS || raw->unpack() != LIBRAW_SUCCESS) ++failures;
    });
  });
  if (failures > 0) {
    return Error{ErrorKind::kInternal, "LibRaw cannot read our own DNG", files.front().string(), "", ""};
  }
  return seconds;
}

}  // namespace weft::bench
