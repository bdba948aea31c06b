// SPDX-License-Identifier: Apache-2.0
#include "core/base/job_context.h"

#include <mutex>
#include <optional>

#include "core/base/parallel.h"

namespace weft {

Result<void> for_each_frame(std::size_t count, const JobContext& context,
                            const std::function<Result<void>(std::size_t)>& read) {
  std::optional<Error> failure;
  std::mutex mutex;
  std::size_t done = 0;
  parallel_for(count, context.threads, [&](std::size_t i, int) {
    {
      const std::lock_guard lock(mutex);
      if (failure || context.stop.stop_requested()) return;
    }
    Result<void> result = read(i);
    const std::lock_guard lock(mutex);
    if (!result && !failure) failure = std::move(result).error();
    context.progress("read", static_cast<double>(++done) / static_cast<double>(count));
  });
  if (failure) return *failure;
  if (context.stop.stop_requested()) return interrupted();
  return {};
}

}  // namespace weft
