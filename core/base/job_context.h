// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <string_view>

#include "core/base/result.h"

namespace weft {

/// Called as a job advances: the phase it is in ("read", "solve") and the share of it that is done, 0 to 1.
/// May be called from any thread, one call at a time a phase.
using Progress = std::function<void(std::string_view phase, double share)>;

/// What every job needs to know of its caller.
struct JobContext {
  int threads = 0;  ///< 0: all the machine has
  std::stop_token stop = {};
  Progress progress = [](std::string_view, double) {};
};

/// Runs read(i) for every frame 0 <= i < count in parallel and reports the phase "read". The first error
/// stops it and is returned; so does the caller's stop token.
Result<void> for_each_frame(std::size_t count, const JobContext& context,
                            const std::function<Result<void>(std::size_t i)>& read);

inline Error interrupted() {
  return {ErrorKind::kInterrupted, "interrupted", "", "stopped on request", ""};
}

/// Wall seconds since it was made or last read.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    begin_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace weft
