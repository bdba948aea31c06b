// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace weft {
namespace {

constexpr std::array<int, 3> kThreads = {1, 2, 7};

TEST(ParallelFor, CallsEveryIndexOnce) {
  for (const int threads : kThreads) {
    for (const std::size_t count : {0U, 1U, 2U, 5U, 1000U}) {
      std::vector<int> calls(count);
      parallel_for(count, threads, [&](std::size_t i, int) { ++calls[i]; });
      EXPECT_EQ(std::count(calls.begin(), calls.end(), 1), static_cast<std::ptrdiff_t>(count))
          << threads << " threads";
    }
  }
}

TEST(ParallelFor, WorkersAreBelowTheThreadsAndNeverOverlap) {
  for (const int threads : kThreads) {
    std::array<std::atomic<bool>, 7> busy = {};
    std::atomic<int> strangers = 0, overlaps = 0;
    parallel_for(300, threads, [&](std::size_t, int worker) {
      if (worker < 0 || worker >= threads) {
        ++strangers;
        return;
      }
      std::atomic<bool>& mine = busy[static_cast<std::size_t>(worker)];
      if (mine.exchange(true)) ++overlaps;
      std::this_thread::yield();
      mine = false;
    });
    EXPECT_EQ(strangers, 0) << threads << " threads";
    EXPECT_EQ(overlaps, 0) << threads << " threads";
  }
}

// Under ThreadSanitizer this fails if two calls share a worker or if the end of the loop does not wait.
TEST(ParallelFor, ScratchOfAWorkerNeedsNoLockAndASharedSumNeedsOne) {
  constexpr std::size_t kCount = 20'000;
  for (const int threads : kThreads) {
    std::vector<std::size_t> scratch(static_cast<std::size_t>(threads));
    std::size_t shared = 0;
    std::mutex mutex;
    parallel_for(kCount, threads, [&](std::size_t i, int worker) {
      scratch[static_cast<std::size_t>(worker)] += i;
      const std::lock_guard lock(mutex);
      shared += i;
    });
    constexpr std::size_t kSum = kCount * (kCount - 1) / 2;
    EXPECT_EQ(std::accumulate(scratch.begin(), scratch.end(), std::size_t{0}), kSum) << threads << " threads";
    EXPECT_EQ(shared, kSum) << threads << " threads";
  }
}

TEST(ParallelFor, RethrowsAnExceptionOnceTheOthersHaveEnded) {
  for (const int threads : kThreads) {
    std::atomic<int> running = 0;
    try {
      parallel_for(500, threads, [&](std::size_t i, int) {
        ++running;
        std::this_thread::yield();
        --running;
        if (i == 57) throw std::runtime_error("at 57");
      });
      ADD_FAILURE() << "nothing was thrown on " << threads << " threads";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "at 57");
    }
    EXPECT_EQ(running, 0) << threads << " threads";
  }
}

TEST(ParallelFor, StartsNothingMoreAfterAnException) {
  int calls = 0;
  EXPECT_THROW(parallel_for(500, 1,
                            [&](std::size_t i, int) {
                              ++calls;
                              if (i == 3) throw std::runtime_error("at 3");
                            }),
               std::runtime_error);
  EXPECT_EQ(calls, 4);
}

TEST(ParallelFor, MayRunInsideItself) {
  std::atomic<int> calls = 0;
  parallel_for(5, 2, [&](std::size_t, int) { parallel_for(7, 2, [&](std::size_t, int) { ++calls; }); });
  EXPECT_EQ(calls, 35);
}

TEST(ParallelFor, ZeroThreadsAreAllTheMachineHas) {
  EXPECT_GE(hardware_threads(), 1);
  EXPECT_EQ(resolved_threads(0), hardware_threads());
  EXPECT_EQ(resolved_threads(-1), hardware_threads());
  EXPECT_EQ(resolved_threads(3), 3);
}

}  // namespace
}  // namespace weft
