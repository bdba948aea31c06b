// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/worker_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

#include "core/base/files.h"

namespace weft::capture {
namespace {

using Steady = std::chrono::steady_clock;

constexpr std::size_t kLongestLine = std::size_t{1} << 20;
constexpr std::uintmax_t kMostLogBytes = std::uintmax_t{1} << 20;
constexpr double kKill_s = 10;  // for the system to clear a killed process away

Error hung(const std::string& why) {
  return {ErrorKind::kTryAgain, "the camera hangs", "weft-camera", why,
          "try again; if it stays so, switch the camera off and on"};
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
  Descriptor ours(sockets[0]);
  const Descriptor its(sockets[1]);
  if (!log.empty()) turn_over(log);
  const Descriptor said = log.empty() ? Descriptor() : Descriptor(log, O_WRONLY | O_CREAT | O_APPEND);
  if (!log.empty() && !said) return cannot_write(log, errno);
  ProcessStart start = {.command = {program.string()},
                        .input = its.get(),
                        .output = its.get(),
                        .errors = log.empty() ? STDERR_FILENO : said.get(),
                        .group = ProcessGroup::kOwn};
  for (const auto& [name, value] : environment)
    start.environment.push_back(fmt::format("{}={}", name, value));
  auto started = ChildProcess::start(start);
  if (started) {
    return std::unique_ptr<WorkerProcess>(new WorkerProcess(std::move(*started), std::move(ours)));
  }
  return Error{started.error().kind, "the camera's program cannot be started", program.string(),
               started.error().why, "install weft whole: weft-camera belongs beside weft"};
}

WorkerProcess::~WorkerProcess() {
  end(Steady::now());
}

Result<void> WorkerProcess::send(std::string_view line) {
  std::string bytes(line);
  bytes += '\n';
  const ssize_t sent = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent == static_cast<ssize_t>(bytes.size())) return {};
  return sent < 0 && errno == EPIPE ? ended() : hung("it does not read what it is asked");
}

bool WorkerProcess::wait_readable(Deadline deadline) const {
  pollfd readable = {socket_.get(), POLLIN, 0};
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
  const ssize_t n = ::recv(socket_.get(), block.data(), block.size(), MSG_DONTWAIT);
  if (n < 0 && (errno == EINTR || errno == EAGAIN)) return {};
  if (n <= 0) return ended();
  received_.append(block.data(), static_cast<std::size_t>(n));
  return {};
}

void WorkerProcess::end(Deadline deadline) {
  ::shutdown(socket_.get(), SHUT_WR);
  if (process_->wait(std::chrono::duration<double>(deadline - Steady::now()).count())) return;
  process_->signal(SIGKILL);
  process_->wait(kKill_s);
}

/// It has closed its end of the socket, so that it is dead or about to be.
Error WorkerProcess::ended() {
  end(Steady::now() + std::chrono::milliseconds(500));
  const int killed_by = process_->killed_by();
  const std::string why = killed_by != 0
                              ? fmt::format("killed by signal {}, {}", killed_by, strsignal(killed_by))
                              : fmt::format("ended with code {}", process_->wait(0).value_or(0));
  return {ErrorKind::kTryAgain, "the camera's program has ended", "weft-camera", why,
          "take the photograph again"};
}

}  // namespace weft::capture
