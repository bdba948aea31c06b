// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/worker_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

#include "core/files.h"
#include "core/process.h"

namespace weft::capture {
namespace {

using Steady = std::chrono::steady_clock;

constexpr std::size_t kLongestLine = std::size_t{1} << 20;
constexpr std::uintmax_t kMostLogBytes = std::uintmax_t{1} << 20;

Error hung(const std::string& why) {
  return {ErrorKind::kTryAgain, "the camera hangs", "weft-camera", why,
          "try again; if it stays so, switch the camera off and on"};
}

/// This process's variables with some replaced.
std::vector<std::string> merged(const Environment& environment) {
  std::vector<std::string> all;
  for (char** each = environ; *each != nullptr; ++each) {
    const std::string_view variable = *each;
    const std::string_view name = variable.substr(0, variable.find('='));
    if (std::ranges::none_of(environment, [name](const auto& own) { return own.first == name; }))
      all.emplace_back(variable);
  }
  for (const auto& [name, value] : environment) all.push_back(fmt::format("{}={}", name, value));
  return all;
}

/// Starts the program with one end of a socket as its input and output, in a process group of its own and
/// with no signal blocked; errno.
int spawn(const std::filesystem::path& program, const Environment& environment,
          const std::filesystem::path& log, int socket, pid_t& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, socket, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, socket, STDOUT_FILENO);
  if (!log.empty())
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND,
                                     0644);
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);

  std::string path = program.string();
  std::array<char*, 2> arguments = {path.data(), nullptr};
  std::vector<std::string> variables = merged(environment);
  std::vector<char*> pointers;
  for (std::string& variable : variables) pointers.push_back(variable.data());
  pointers.push_back(nullptr);
  const int failed =
      posix_spawn(&pid, path.c_str(), &actions, &attributes, arguments.data(), pointers.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return failed;
}

/// A log that has grown becomes LOG.1: what a crash said outlives the next start.
void turn_over(const std::filesystem::path& log) {
  std::error_code ignored;
  const std::uintmax_t bytes = std::filesystem::file_size(log, ignored);
  if (!ignored && bytes > kMostLogBytes) std::filesystem::rename(log, log.string() + ".1", ignored);
}

}  // namespace

std::filesystem::path weft_camera_program() {
  return program_beside("weft-camera");
}

Result<std::unique_ptr<WorkerProcess>> WorkerProcess::start(const std::filesystem::path& program,
                                                            const Environment& environment,
                                                            const std::filesystem::path& log) {
  // A socket, not two pipes: writing to a dead one can be told not to raise SIGPIPE.
  std::array<int, 2> sockets;
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0)
    return Error{ErrorKind::kTryAgain, "no socket for weft-camera", "", system_reason(errno), "try again"};
  if (!log.empty()) turn_over(log);
  pid_t pid = 0;
  const int failed = spawn(program, environment, log, sockets[1], pid);
  ::close(sockets[1]);
  if (failed == 0) return std::unique_ptr<WorkerProcess>(new WorkerProcess(pid, sockets[0]));
  ::close(sockets[0]);
  return Error{failed == EAGAIN || failed == ENOMEM ? ErrorKind::kTryAgain : ErrorKind::kNoInput,
               "the camera's program cannot be started", program.string(), system_reason(failed),
               "install weft whole: weft-camera belongs beside weft"};
}

WorkerProcess::~WorkerProcess() {
  end(Steady::now());
  ::close(socket_);
}

Result<void> WorkerProcess::send(std::string_view line) {
  std::string bytes(line);
  bytes += '\n';
  const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent == static_cast<ssize_t>(bytes.size())) return {};
  return sent < 0 && errno == EPIPE ? ended() : hung("it does not read what it is asked");
}

bool WorkerProcess::wait_readable(Deadline deadline) const {
  pollfd readable = {socket_, POLLIN, 0};
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Steady::now()).count();
    const int ready = ::poll(&readable, 1, static_cast<int>(std::clamp(left, 0L, 3'600'000L)));
    if (ready > 0) return true;
    if (ready == 0 && Steady::now() >= deadline) return false;
    if (ready < 0 && errno != EINTR) return false;
  }
}

Result<std::string> WorkerProcess::read_line(Deadline deadline) {
  for (;;) {
    if (const std::size_t at = received_.find('\n'); at != std::string::npos) {
      std::string line = received_.substr(0, at);
      received_.erase(0, at + 1);
      return line;
    }
    if (received_.size() > kLongestLine) return hung("it does not end its line");
    if (Result<void> more = receive(deadline); !more) return std::move(more).error();
  }
}

Result<std::string> WorkerProcess::read_bytes(std::size_t count, Deadline deadline) {
  while (received_.size() < count) {
    if (Result<void> more = receive(deadline); !more) return std::move(more).error();
  }
  std::string bytes = received_.substr(0, count);
  received_.erase(0, count);
  return bytes;
}

Result<void> WorkerProcess::receive(Deadline deadline) {
  if (!wait_readable(deadline)) return hung("it has not answered in time");
  std::array<char, 16384> block;
  const ssize_t n = ::recv(socket_, block.data(), block.size(), MSG_DONTWAIT);
  if (n < 0 && (errno == EINTR || errno == EAGAIN)) return {};
  if (n <= 0) return ended();
  received_.append(block.data(), static_cast<std::size_t>(n));
  return {};
}

void WorkerProcess::end(Deadline deadline) {
  if (pid_ <= 0) return;
  ::shutdown(socket_, SHUT_WR);
  while (::waitpid(pid_, &status_, WNOHANG) == 0) {
    if (Steady::now() < deadline) {
      ::usleep(2000);
      continue;
    }
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
    }
    break;
  }
  pid_ = 0;
}

/// It has closed its end of the socket, so that it is dead or about to be.
Error WorkerProcess::ended() {
  end(Steady::now() + std::chrono::milliseconds(500));
  const std::string why = WIFSIGNALED(status_) ? fmt::format("killed by signal {}, {}", WTERMSIG(status_),
                                                             strsignal(WTERMSIG(status_)))
                                               : fmt::format("ended with code {}", WEXITSTATUS(status_));
  return {ErrorKind::kTryAgain, "the camera's program has ended", "weft-camera", why,
          "take the photograph again"};
}

}  // namespace weft::capture
