// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/descriptor.h"
#include "core/base/process.h"
#include "core/base/result.h"

namespace weft::capture {

using Environment = std::vector<std::pair<std::string, std::string>>;

/// weft-camera, where it is installed: beside the running program.
std::filesystem::path weft_camera_program();

/// A child process that is spoken to in lines. It never outlives this object, nor keeps anybody waiting past
/// a deadline. Signals of the terminal do not reach it.
class WorkerProcess {
 public:
  using Deadline = std::chrono::steady_clock::time_point;

  /// Starts `program` with these variables on top of this process's; what it says on its standard error goes
  /// to the end of the file `log` (one over 1 MB becomes LOG.1 first), or where this process's goes.
  /// kNoInput, kTryAgain.
  static Result<std::unique_ptr<WorkerProcess>> start(const std::filesystem::path& program,
                                                      const Environment& environment,
                                                      const std::filesystem::path& log = {});
  /// Kills it if it is still there.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  pid_t pid() const { return process_->pid(); }
  /// Sends a line. kTryAgain where it is dead or takes nothing any more.
  Result<void> send(std::string_view line);
  /// The next line without its end. kTryAgain at the deadline, and where it has ended: `why` says by what.
  Result<std::string> read_line(Deadline deadline);
  /// So many bytes that follow a line. kTryAgain as read_line().
  Result<std::string> read_bytes(std::size_t count, Deadline deadline);
  /// Closes its input, gives it until the deadline to end, then kills it.
  void end(Deadline deadline);

 private:
  WorkerProcess(std::unique_ptr<ChildProcess> process, Descriptor socket)
      : process_(std::move(process)), socket_(std::move(socket)) {}
  bool wait_readable(Deadline deadline) const;
  Result<void> receive(Deadline deadline);
  Error ended();

  std::unique_ptr<ChildProcess> process_;
  Descriptor socket_;
  std::string received_;
};

}  // namespace weft::capture
