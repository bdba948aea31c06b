// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/program/background.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>

#include "app/cli/exit_code.h"
#include "core/base/descriptor.h"
#include "core/base/process.h"

namespace weft::virtual_rig {
namespace {

ssize_t read_one(int fd) {
  char byte = 0;
  ssize_t n = 0;
  do {
    n = ::read(fd, &byte, 1);
  } while (n < 0 && errno == EINTR);
  return n;
}

}  // namespace

int run_in_background(const std::vector<std::string>& arguments) {
  std::array<int, 2> ends = {};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return app::kTryAgainError;
  const Descriptor ready(ends[0]);
  Descriptor its(ends[1]);
  ProcessStart again = {
      .command = {program_beside("weft-virtual-rig").string(), "--ready", std::to_string(its.get())},
      .input = STDIN_FILENO,
      .output = STDOUT_FILENO,
      .errors = STDERR_FILENO,
      .handed_on = its.get(),
      .group = ProcessGroup::kOwnSession};
  again.command.insert(again.command.end(), arguments.begin(), arguments.end());
  const Result<pid_t> child = start_process(again);
  its = Descriptor();
  if (!child) return app::kTryAgainError;
  if (read_one(ready.get()) == 1) return app::kDone;
  int status = 0;
  while (::waitpid(*child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void detach(int ready) {
  if (ready < 0) return;
  std::fflush(nullptr);
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(null, stream);
  ::close(null);
  const char byte = 1;
  while (::write(ready, &byte, 1) < 0 && errno == EINTR) {
  }
  ::close(ready);
}

}  // namespace weft::virtual_rig
