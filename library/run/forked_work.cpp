// SPDX-License-Identifier: Apache-2.0
#include "library/run/forked_work.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/files.h"

namespace weft::library {
namespace {

constexpr int kThrew = 1;

volatile std::sig_atomic_t asked_to_stop = 0;

void on_stop_signal(int) {
  asked_to_stop = 1;
}

void say(int to, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = ::write(to, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return;
    done += static_cast<std::size_t>(n);
  }
}

void limit_memory(std::uint64_t bytes) {
  if (bytes == 0) return;
  // Writable memory, and not address space: libraries and the reserve of malloc's arenas count nothing.
  const rlimit limit = {bytes, bytes};
  ::setrlimit(RLIMIT_DATA, &limit);
}

// Whether a thread, for one, could not be had for want of memory.
bool is_want_of_memory(const std::system_error& error) {
  return error.code() == std::errc::resource_unavailable_try_again ||
         error.code() == std::errc::not_enough_memory;
}

int run_here(const std::function<std::string(std::stop_token)>& work, int to) {
  try {
    std::stop_source source;
    std::jthread watcher([&source](const std::stop_token& ending) {
      while (!ending.stop_requested()) {
        if (asked_to_stop != 0) source.request_stop();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    });
    say(to, work(source.get_token()));
    return 0;
  } catch (const std::bad_alloc&) {
    return ForkedWork::kOutOfMemory;
  } catch (const std::system_error& error) {
    say(to, error.what());
    return is_want_of_memory(error) ? ForkedWork::kOutOfMemory : kThrew;
  } catch (const std::exception& bug) {
    say(to, bug.what());
    return kThrew;
  }
}

[[noreturn]] void become_work(const std::function<std::string(std::stop_token)>& work, int to, pid_t parent,
                              std::uint64_t memory_bytes) {
  asked_to_stop = 0;
  std::signal(SIGTERM, on_stop_signal);
  std::signal(SIGINT, on_stop_signal);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kThrew);
  limit_memory(memory_bytes);
  const int code = run_here(work, to);
  ::_exit(code);
}

}  // namespace

Result<std::unique_ptr<ForkedWork>> ForkedWork::start(const std::function<std::string(std::stop_token)>& work,
                                                      std::uint64_t memory_bytes) {
  std::array<int, 2> ends = {-1, -1};
  const auto refused = [](int reason) {
    return Error{ErrorKind::kTryAgain, "a process cannot be started", "", system_reason(reason),
                 "close other programs"};
  };
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return refused(errno);
  Descriptor from(ends[0]), to(ends[1]);
  ::fcntl(from.get(), F_SETFL, O_NONBLOCK);
  std::fflush(nullptr);
  const pid_t parent = ::getpid(), child = ::fork();
  if (child < 0) return refused(errno);
  if (child == 0) become_work(work, to.get(), parent, memory_bytes);
  return std::unique_ptr<ForkedWork>(new ForkedWork(child, std::move(from)));
}

ForkedWork::~ForkedWork() {
  if (is_over_) return;
  ::kill(pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void ForkedWork::wait_for_any(const std::vector<const ForkedWork*>& works, int most_ms) {
  std::vector<pollfd> waiting;
  for (const ForkedWork* work : works) {
    // One that has closed its end is about to be gone.
    if (work->is_silent_) most_ms = std::min(most_ms, 1);
    if (!work->is_silent_) waiting.push_back({work->from_.get(), POLLIN, 0});
  }
  ::poll(waiting.data(), waiting.size(), most_ms);
}

std::optional<ForkedEnd> ForkedWork::ended() {
  std::array<char, 4096> block = {};
  while (!is_silent_) {
    const ssize_t n = ::read(from_.get(), block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) break;  // nothing at the moment
    if (n == 0) is_silent_ = true;
    said_.append(block.data(), static_cast<std::size_t>(n));
  }
  if (is_over_ || !is_silent_) return {};
  int status = 0;
  rusage usage = {};
  if (::wait4(pid_, &status, WNOHANG, &usage) != pid_) return {};
  is_over_ = true;
  ForkedEnd end;
  if (WIFSIGNALED(status)) {
    end.signal = WTERMSIG(status);
  } else {
    end.code = WEXITSTATUS(status);
  }
  end.said = std::move(said_);
  end.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  return end;
}

void ForkedWork::signal(int number) const {
  if (!is_over_) ::kill(pid_, number);
}

void give_way() {
  constexpr int kNicest = 19;
  ::setpriority(PRIO_PROCESS, 0, kNicest);
  // Best effort, of its eight levels the last; glibc has no call for it.
  constexpr long kThisProcess = 1, kBestEffortLast = (2L << 13) | 7;
  ::syscall(SYS_ioprio_set, kThisProcess, 0, kBestEffortLast);
}

}  // namespace weft::library
