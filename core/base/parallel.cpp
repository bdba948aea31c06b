// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

#ifdef WEFT_PLAIN_THREADS
#include <thread>
#include <vector>
#else
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#endif

namespace weft {
namespace {

// Runs worker(w) for w = 0 .. threads - 1 at the same time, as far as the machine allows.
#ifdef WEFT_PLAIN_THREADS
void run_workers(int threads, const std::function<void(int)>& worker) {
  std::vector<std::thread> others;
  for (int w = 1; w < threads; ++w) others.emplace_back(worker, w);
  worker(0);
  for (std::thread& t : others) t.join();
}
#else
void run_workers(int threads, const std::function<void(int)>& worker) {
  // Without this, asking for more threads than the machine has makes oneTBB complain on standard error.
  const oneapi::tbb::global_control allow(oneapi::tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(std::max(threads, hardware_threads())));
  oneapi::tbb::task_arena arena(threads);
  arena.execute([&] { oneapi::tbb::parallel_for(0, threads, worker, oneapi::tbb::simple_partitioner{}); });
}
#endif

}  // namespace

int hardware_threads() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return std::max(1, CPU_COUNT(&set));
}

int resolved_threads(int threads) {
  return threads > 0 ? threads : hardware_threads();
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t, int)>& body) {
  const int workers = static_cast<int>(std::min(count, static_cast<std::size_t>(resolved_threads(threads))));
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&](int worker) {
    try {
      for (std::size_t i = next++; i < count; i = next++) body(i, worker);
    } catch (...) {
      next = count;
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  if (workers <= 1) {
    work(0);
  } else {
    run_workers(workers, work);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace weft
