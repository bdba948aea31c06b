// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>

namespace weft::bench {

/// Bytes a process holds in memory, and its open descriptors; nothing once it is gone.
struct ProcessSize {
  std::uint64_t resident_bytes = 0;
  int descriptors = 0;
};
std::optional<ProcessSize> size_of(pid_t pid);

/// The first child of a process with this name, as /proc/PID/comm has it.
std::optional<pid_t> child_of(pid_t parent, const std::string& name);

}  // namespace weft::bench
