// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

namespace weft::virtual_rig {

/// A child that is a client of its own, for what kills or blocks one. Made before any thread of this process;
/// it begins when it is told the camera's port.
class ClientProcess {
 public:
  /// `client` is run in the child with what begin() was given; what it returns is the child's exit code.
  explicit ClientProcess(const std::function<int(const std::string& port)>& client);
  /// Kills it.
  ~ClientProcess();
  ClientProcess(const ClientProcess&) = delete;
  ClientProcess& operator=(const ClientProcess&) = delete;

  void begin(const std::string& port);
  void kill();

  struct End {
    bool ended = false;  ///< within the deadline
    int exit_code = -1;
    int signal = 0;  ///< that ended it
  };
  End wait(double deadline_s);

 private:
  pid_t child_ = -1;
  int pipe_ = -1;
};

/// What a program printed and how it ended. Its environment is this process's and `environment`,
/// "NAME=value".
struct ProgramRun {
  int exit_code = -1;
  std::string output;  ///< standard output and error
};
ProgramRun run_program(const std::vector<std::string>& command, const std::vector<std::string>& environment,
                       const std::string& folder, double deadline_s);

}  // namespace weft::virtual_rig
