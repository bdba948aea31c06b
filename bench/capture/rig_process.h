// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/json_document.h"
#include "core/result.h"

namespace weft::bench {

/// A program that runs beside this one, killed with this object if it still does.
class ChildProcess {
 public:
  /// Standard output and error go to `log`; empty: to this one's standard error. `environment` is NAME=value
  /// on top of this process's.
  static Result<std::unique_ptr<ChildProcess>> start(const std::vector<std::string>& command,
                                                     const std::vector<std::string>& environment,
                                                     const std::filesystem::path& log);
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

struct RigProcessOptions {
  std::filesystem::path programs;  ///< folder with weft, weft-camera and weft-virtual-rig
  std::filesystem::path scene;
  std::filesystem::path folder;
  std::optional<double> megapixels = {};  ///< else the scene's
  bool usb = false;
  bool same_noise = false;  ///< a shot taken again is the same picture
};

/// weft-virtual-rig as a process of its own.
class RigProcess {
 public:
  static Result<std::unique_ptr<RigProcess>> start(const RigProcessOptions& options);

  /// One line to its control socket, and what it answers; kUsage where that is an error.
  Result<std::string> say(const std::string& line) const;
  /// Starts a program in the rig's environment, WEFT_RIG set.
  Result<std::unique_ptr<ChildProcess>> run(const std::vector<std::string>& command,
                                            const std::string& log) const;
  /// `weft` with these arguments.
  Result<std::unique_ptr<ChildProcess>> weft(std::vector<std::string> arguments,
                                             const std::string& log) const;

  const std::filesystem::path& folder() const { return options_.folder; }
  pid_t pid() const { return process_->pid(); }

 private:
  RigProcess(RigProcessOptions options, std::unique_ptr<ChildProcess> process,
             std::vector<std::string> environment)
      : options_(std::move(options)), environment_(std::move(environment)), process_(std::move(process)) {}

  RigProcessOptions options_;
  std::vector<std::string> environment_;
  std::unique_ptr<ChildProcess> process_;
};

/// Bytes a process holds in memory, and its open descriptors; nothing once it is gone.
struct ProcessSize {
  std::uint64_t resident_bytes = 0;
  int descriptors = 0;
};
std::optional<ProcessSize> size_of(pid_t pid);

/// The first child of a process with this name, as /proc/PID/comm has it.
std::optional<pid_t> child_of(pid_t parent, const std::string& name);

}  // namespace weft::bench
