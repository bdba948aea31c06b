// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "core/base/result.h"

namespace weft::virtual_rig {

/// A Unix socket that takes one command a line and answers each with one line. Any number of clients; one
/// that says nothing is dropped after ten seconds, one whose line is over 1000 bytes at once.
class ControlSocket {
 public:
  /// Called on the socket's own thread, one at a time; what it returns is sent without its line ends.
  using Answer = std::function<std::string(const std::string& line)>;

  /// kCannotCreate where the path is too long for a socket (107 bytes) or may not be made. What is there
  /// under that path is replaced.
  static Result<std::unique_ptr<ControlSocket>> listen(const std::filesystem::path& path, Answer answer);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

 private:
  ControlSocket(std::filesystem::path path, Answer answer);
  void serve();

  std::filesystem::path path_;
  Answer answer_;
  int listening_ = -1;
  int wake_ = -1;
  std::thread thread_;
};

/// Sends one command and returns its answer. kNoDevice where nothing listens, kTryAgain where no answer comes
/// in `deadline_s`: what is laid on the table of a large camera is rendered first.
Result<std::string> send_command(const std::filesystem::path& socket, const std::string& line,
                                 double deadline_s = 600);

/// As send_command(); kUsage where the rig refuses the line.
Result<std::string> tell_rig(const std::filesystem::path& socket, const std::string& line,
                             double deadline_s = 600);

}  // namespace weft::virtual_rig
