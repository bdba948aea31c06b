// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/result.h"

namespace weft {

/// Another program of weft: beside the running one, as they are built, else where they are installed, which
/// is bin/ for what people call and libexec/weft/ for all else of one prefix. Beside the running one where it
/// is nowhere.
std::filesystem::path program_beside(const std::string& name);

/// Becomes `program` with these arguments: its output and exit code are this process's. Returns only where
/// that fails. kNoInput.
Error become(const std::filesystem::path& program, const std::vector<std::string>& arguments);

/// Where a standard stream of a program leads: a descriptor of this process, or a file that is made or
/// emptied.
using Stream = std::variant<int, std::filesystem::path>;
inline constexpr int kNullDevice = -1, kAsOutput = -2;

enum class ProcessGroup { kOfParent, kOwn, kOwnSession };

/// What a program is started with.
struct ProcessStart {
  std::vector<std::string> command = {};      ///< program and arguments; along $PATH where it has no slash
  std::vector<std::string> environment = {};  ///< NAME=value on top of this process's
  Stream input = kNullDevice, output = kNullDevice, errors = kAsOutput;
  int handed_on = -1;                            ///< a descriptor that is open in it, too, by its number
  ProcessGroup group = ProcessGroup::kOfParent;  ///< signals of the terminal reach that of the parent alone
  bool ends_with_parent = false;                 ///< killed once the thread that started it is gone
  int niceness = 0;                              ///< on top of this process's, 0 to 19
  std::uint64_t memory_bytes = 0;                ///< that it may write to (RLIMIT_DATA); 0: any number
};

/// Starts a program, which may outlive this one. No signal is blocked in it, and SIGINT, SIGTERM and SIGPIPE
/// end it. kNoInput; kTryAgain where the system has no more processes; as cannot_write() of its files.
Result<pid_t> start_process(const ProcessStart& start);

/// A program that runs beside this one, killed with this object if it still does.
class ChildProcess {
 public:
  /// Errors as start_process().
  static Result<std::unique_ptr<ChildProcess>> start(const ProcessStart& start);
  /// Standard output and error go to `log`; empty: to this one's standard error. Where `errors` is named,
  /// standard error goes there.
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
  int wait();
  /// The signal that killed it; 0: none did, or it still runs.
  int killed_by() const { return killed_by_; }
  /// What it has printed.
  std::string said() const;

 private:
  ChildProcess(pid_t pid, std::filesystem::path log) : pid_(pid), log_(std::move(log)) {}

  pid_t pid_;
  std::filesystem::path log_;
  std::optional<int> code_;
  int killed_by_ = 0;
};

}  // namespace weft
