// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/program/run.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <future>
#include <optional>

#include "app/cli/exit_code.h"
#include "core/base/process.h"
#include "virtual_rig/program/background.h"
#include "virtual_rig/rig_process.h"

namespace weft::virtual_rig {
namespace {

constexpr int kPoll_ms = 100;
constexpr double kGrace_s = 10;
constexpr pid_t kNoParent = 0;

/// SIGINT, SIGTERM and SIGCHLD as a descriptor: no thread is interrupted by them.
class Signals {
 public:
  Signals() {
    sigemptyset(&set_);
    for (const int signal : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&set_, signal);
    ::pthread_sigmask(SIG_BLOCK, &set_, &before_);
    fd_ = ::signalfd(-1, &set_, SFD_CLOEXEC | SFD_NONBLOCK);
  }
  ~Signals() {
    ::close(fd_);
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  int descriptor() const { return fd_; }
  /// The next one that has come, if any; a child's end is none.
  std::optional<int> take() const {
    signalfd_siginfo info = {};
    while (::read(fd_, &info, sizeof info) == static_cast<ssize_t>(sizeof info)) {
      if (info.ssi_signo != SIGCHLD) return static_cast<int>(info.ssi_signo);
    }
    return {};
  }

 private:
  sigset_t set_ = {}, before_ = {};
  int fd_ = -1;
};

/// A program that runs inside the rig's environment.
Result<std::unique_ptr<ChildProcess>> start_inside(const VirtualRig& rig,
                                                   const std::vector<std::string>& command) {
  auto child = ChildProcess::start({.command = command,
                                    .environment = rig.environment(),
                                    .input = STDIN_FILENO,
                                    .output = STDOUT_FILENO,
                                    .errors = STDERR_FILENO});
  if (child) return child;
  return Error{ErrorKind::kNoInput, "cannot run", command[0], child.error().why,
               "name a program and its arguments after --"};
}

/// VirtualRig::start() that a signal ends.
Result<std::unique_ptr<VirtualRig>> start_rig(VirtualRigOptions options, const Signals& signals) {
  std::stop_source stop;
  options.render.stop = stop.get_token();
  options.render.progress = [last = -1](double share) mutable {
    const int percent = 5 * static_cast<int>(20 * share);
    if (std::exchange(last, percent) != percent) fmt::print(stderr, "{} {} %\n", kRenders, percent);
  };
  auto starting = std::async(std::launch::async, [&options] { return VirtualRig::start(options); });
  while (starting.wait_for(std::chrono::milliseconds(kPoll_ms)) != std::future_status::ready) {
    if (signals.take()) stop.request_stop();
  }
  return starting.get();
}

void say_ready(const VirtualRig& rig, const std::filesystem::path& folder) {
  for (const std::string& left_out : rig.frames().left_out()) {
    fmt::print(stderr, "left out: {}\n", left_out);
  }
  const Size size = rig.frames().size();
  fmt::print(
      "READY {0}\n"
      "  {1} LEDs, {2} x {3} pixels; light from {4}\n"
      "  rig file        {0}/rig.toml\n"
      "  use it          env $(cat {0}/environment) weft scan --fabric NAME\n"
      "  break it        weft-virtual-rig --folder {0} --inject \"board unplug\"\n"
      "  end it          Ctrl-C, or weft-virtual-rig --folder {0} --inject end\n",
      folder.string(), rig.frames().leds(), size.width, size.height, rig.frames().folder().string());
  std::fflush(stdout);
}

/// Until a signal (its number), "end" (nothing) or the end of the parent or child (nothing, or its code).
Result<int> wait_for_end(const VirtualRig& rig, ChildProcess* child, const Signals& signals, pid_t parent) {
  while (true) {
    std::array<pollfd, 2> waiting = {pollfd{signals.descriptor(), POLLIN, 0},
                                     pollfd{rig.end_descriptor(), POLLIN, 0}};
    ::poll(waiting.data(), waiting.size(), kPoll_ms);
    if (signals.take()) return child != nullptr ? app::kInterruptedError : app::kDone;
    if (waiting[1].revents != 0) return app::kDone;
    if (child != nullptr) {
      if (const std::optional<int> code = child->wait(0)) return *code;
    }
    if (parent != kNoParent && ::getppid() != parent) return app::kDone;
  }
}

}  // namespace

Result<int> run_virtual_rig(const VirtualRigOptions& options, const std::vector<std::string>& command,
                            int ready) {
  const Signals signals;
  const pid_t parent = ::getppid();
  Result<std::unique_ptr<VirtualRig>> rig = start_rig(options, signals);
  if (!rig) return rig.error();
  if (command.empty()) {
    say_ready(**rig, std::filesystem::absolute(options.folder).lexically_normal());
    detach(ready);
    return wait_for_end(**rig, nullptr, signals, ready < 0 ? parent : kNoParent);
  }
  const Result<std::unique_ptr<ChildProcess>> child = start_inside(**rig, command);
  if (!child) return child.error();
  const Result<int> code = wait_for_end(**rig, child->get(), signals, parent);
  (*child)->signal(SIGTERM);
  (*child)->wait(kGrace_s);
  return code;
}

}  // namespace weft::virtual_rig
