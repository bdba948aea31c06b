// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace weft::library {

/// How a process of our own ended.
struct ForkedEnd {
  int signal = 0;  ///< that killed it; 0: none did
  int code = 0;
  std::string said;              ///< what the work returned
  std::uint64_t peak_bytes = 0;  ///< of memory that it held at once
};

/// Work in a process of its own, forked from this one and no program of its own (core/base/process), since a
/// function is handed on with all that it holds: whatever becomes of it, memory that runs out or a bug, costs
/// this one nothing. It is killed with this object, and with this process. The caller has not started threads
/// that hold locks, and has run nothing on those of parallel_for(): they do not exist in the fork.
class ForkedWork {
 public:
  /// `work` returns what is said of it; its stop token is that of SIGTERM and SIGINT. What it throws ends the
  /// process with code 1, and std::bad_alloc with kOutOfMemory. `memory_bytes`: of writable memory at most;
  /// 0: as much as there is. kTryAgain where the system has no process or pipe to give.
  static Result<std::unique_ptr<ForkedWork>> start(const std::function<std::string(std::stop_token)>& work,
                                                   std::uint64_t memory_bytes);
  static constexpr int kOutOfMemory = 3;

  ~ForkedWork();
  ForkedWork(const ForkedWork&) = delete;
  ForkedWork& operator=(const ForkedWork&) = delete;

  pid_t pid() const { return pid_; }
  /// Waits until one of them has something to say or has ended, at most so long.
  static void wait_for_any(const std::vector<const ForkedWork*>& works, int most_ms);
  /// Takes what has come. How it ended, once it has.
  std::optional<ForkedEnd> ended();
  void signal(int number) const;

 private:
  ForkedWork(pid_t pid, Descriptor said) : pid_(pid), from_(std::move(said)) {}

  pid_t pid_;
  Descriptor from_;
  std::string said_;
  bool is_silent_ = false;  ///< its end of the pipe is closed
  bool is_over_ = false;
};

/// Has this process, and those it starts, give way to others for the processor and the disk.
void give_way();

}  // namespace weft::library
