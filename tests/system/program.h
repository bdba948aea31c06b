// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_document.h"

namespace weft::test {

/// What a run of weft left behind when it ended.
struct Outcome {
  int exit_code = 0;   ///< 128 + the signal that killed it
  std::string output;  ///< standard output
  std::string error;   ///< standard error

  /// Standard output as the one JSON document it must be; a failed expectation otherwise.
  Json json() const;
};

/// The circumstances of a run.
struct RunOptions {
  std::filesystem::path folder = {};                     ///< the working directory; empty: this one
  std::optional<std::uint64_t> largest_file_bytes = {};  ///< RLIMIT_FSIZE: a write beyond it fails
  bool full_output = false;       ///< standard output goes to a device that is always full
  bool as_nobody = false;         ///< without the rights of root, if these tests have them
  std::string interrupt_at = {};  ///< SIGINT as soon as this has appeared on standard error; empty: never
};

/// Runs weft in a process of its own and waits for its end.
Outcome run_weft(const std::vector<std::string>& arguments, const RunOptions& options = {});

}  // namespace weft::test
