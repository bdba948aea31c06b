// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace weft {

/// Number of hardware threads this process may use, at least 1.
int hardware_threads();

/// Runs body(i, worker) for every 0 <= i < count on `threads` threads (0: all the machine has). `worker` is
/// below the number of threads and two calls with the same worker never overlap, so it can index scratch.
/// The order of calls is unspecified: a body writes only what belongs to its i. Returns when all are done.
/// An exception of a body is rethrown here after the others have ended.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t i, int worker)>& body);

/// What `threads` means: itself where positive, else hardware_threads().
int resolved_threads(int threads);

}  // namespace weft
