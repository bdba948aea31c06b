// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/program/background.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>

#include "app/cli/exit_code.h"
#include "virtual_rig/program/spawn.h"

namespace weft::app {
namespace {

ssize_t read_one(int fd) {
  char byte = 0;
  ssize_t n = 0;
  do {
    n = ::read(fd, &byte, 1);
  } while (n < 0 && errno == EINTR);
  return n;
}

/// This program, which keeps `ready` open and no other end of the pipe.
int spawn_again(std::vector<std::string> arguments, int ready, pid_t& child) {
  std::vector<std::string> command = {"weft-virtual-rig", "--ready", std::to_string(ready)};
  command.insert(command.end(), arguments.begin(), arguments.end());
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, ready, ready);  // to itself: it loses its close-on-exec
  posix_spawnattr_t settings;
  ::posix_spawnattr_init(&settings);
  ::posix_spawnattr_setflags(&settings, POSIX_SPAWN_SETSID);
  const int failed =
      ::posix_spawn(&child, "/proc/self/exe", &files, &settings, pointers_to(command).data(), environ);
  ::posix_spawnattr_destroy(&settings);
  ::posix_spawn_file_actions_destroy(&files);
  return failed;
}

}  // namespace

int run_in_background(std::vector<std::string> arguments) {
  std::array<int, 2> ready = {};
  if (::pipe2(ready.data(), O_CLOEXEC) != 0) return kTryAgainError;
  pid_t child = -1;
  const int failed = spawn_again(std::move(arguments), ready[1], child);
  ::close(ready[1]);
  const bool is_ready = failed == 0 && read_one(ready[0]) == 1;
  ::close(ready[0]);
  if (failed != 0) return kTryAgainError;
  if (is_ready) return kDone;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void detach(int ready) {
  if (ready < 0) return;
  ::prctl(PR_SET_NAME, "weft-virtual-rig");  // the kernel calls what was run as /proc/self/exe "exe"
  std::fflush(nullptr);
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(null, stream);
  ::close(null);
  const char byte = 1;
  while (::write(ready, &byte, 1) < 0 && errno == EINTR) {
  }
  ::close(ready);
}

}  // namespace weft::app
