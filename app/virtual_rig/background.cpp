// SPDX-License-Identifier: Apache-2.0
#include "app/virtual_rig/background.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>

#include "app/cli/exit_code.h"

namespace weft::app {
namespace {

int g_ready = -1;  // the end of a pipe to the process that waits

ssize_t read_one(int fd) {
  char byte = 0;
  ssize_t n = 0;
  do {
    n = ::read(fd, &byte, 1);
  } while (n < 0 && errno == EINTR);
  return n;
}

}  // namespace

std::optional<int> into_background() {
  std::array<int, 2> ready = {};
  if (::pipe2(ready.data(), O_CLOEXEC) != 0) return kTryAgainError;
  const pid_t child = ::fork();
  if (child < 0) return kTryAgainError;
  if (child == 0) {
    ::close(ready[0]);
    ::setsid();
    g_ready = ready[1];
    return {};
  }
  ::close(ready[1]);
  const bool is_ready = read_one(ready[0]) == 1;
  ::close(ready[0]);
  if (is_ready) return kDone;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool detach() {
  if (g_ready < 0) return false;
  std::fflush(nullptr);
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(null, stream);
  ::close(null);
  const char byte = 1;
  while (::write(g_ready, &byte, 1) < 0 && errno == EINTR) {
  }
  ::close(g_ready);
  g_ready = -1;
  return true;
}

}  // namespace weft::app
