// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"

namespace weft {

/// Another program of weft: beside the running one, as they are built, else where they are installed, which
/// is bin/ for what people call and libexec/weft/ for all else of one prefix. Beside the running one where it
/// is nowhere.
std::filesystem::path program_beside(const std::string& name);

/// Becomes `program` with these arguments: its output and exit code are this process's. Returns only where
/// that fails. kNoInput.
Error become(const std::filesystem::path& program, const std::vector<std::string>& arguments);

/// Starts a program, found along $PATH, that outlives this one: in a session of its own, heard by nobody.
/// kNoInput.
Result<void> start_apart(const std::vector<std::string>& command);

/// A program that runs beside this one, killed with this object if it still does.
class ChildProcess {
 public:
  /// Standard output and error go to `log`; empty: to this one's standard error. Where `errors` is named,
  /// standard error goes there. `environment` is NAME=value on top of this process's. kNoInput.
  static Result<std::unique_ptr<ChildProcess>> start(const std::vector<std::string>& command,
                                                     const std::vector<std::string>& environment,
                                                     const std::filesystem::path& log,
                                                     const std::filesystem::path& errors = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  bool runs();
  void signal(int number) const;
  /// Its exit code, 128 + the signal that killed it; nothing where it still runs after `most_s`.
  std::optional<int> wait(double most_s);
  /// What it has printed.
  std::string said() const;

 private:
  ChildProcess(pid_t pid, std::filesystem::path log) : pid_(pid), log_(std::move(log)) {}

  pid_t pid_;
  std::filesystem::path log_;
  std::optional<int> code_;
};

}  // namespace weft
