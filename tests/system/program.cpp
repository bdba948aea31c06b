// SPDX-License-Identifier: Apache-2.0
#include "tests/system/program.h"
#include "tests/core/places.h"

#include <fcntl.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>

namespace weft::test {
namespace {

constexpr uid_t kNobody = 65534;
constexpr int kCannotStart = 127;

/// A file in memory that a child writes into. A pipe would have to be emptied while the child runs.
class Capture {
 public:
  Capture() : fd_(memfd_create("captured", MFD_CLOEXEC)) {}
  ~Capture() { close(fd_); }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;
  int fd() const { return fd_; }

  std::string text() const {
    std::string text;
    std::array<char, 4096> block = {};
    for (;;) {
      const ssize_t n = pread(fd_, block.data(), block.size(), static_cast<off_t>(text.size()));
      if (n <= 0) return text;
      text.append(block.data(), static_cast<std::size_t>(n));
    }
  }

 private:
  int fd_;
};

/// Between fork and exec: system calls only.
[[noreturn]] void become_weft(char* const* arguments, const RunOptions& options, int output, int error) {
  dup2(options.full_output ? open("/dev/full", O_WRONLY | O_CLOEXEC) : output, STDOUT_FILENO);
  dup2(error, STDERR_FILENO);
  if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(kCannotStart);
  if (options.largest_file_bytes) {
    const rlimit limit = {*options.largest_file_bytes, *options.largest_file_bytes};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(kCannotStart);
  }
  if (options.as_nobody && geteuid() == 0) {
    if (setgroups(0, nullptr) != 0 || setgid(kNobody) != 0 || setuid(kNobody) != 0) _exit(kCannotStart);
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  execv(program_path("weft").c_str(), arguments);
  _exit(kCannotStart);
}

}  // namespace

Json Outcome::json() const {
  Json document = Json::parse(output, nullptr, false);
  EXPECT_FALSE(document.is_discarded()) << "standard output is not one JSON document:\n" << output << error;
  return document;
}

Outcome run_weft(const std::vector<std::string>& arguments, const RunOptions& options) {
  const Capture output, error;
  std::vector<std::string> words = {"weft"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child == 0) become_weft(argv.data(), options, output.fd(), error.fd());
  bool to_interrupt = !options.interrupt_at.empty();
  int status = 0;
  for (;;) {
    const pid_t ended = waitpid(child, &status, to_interrupt ? WNOHANG : 0);
    if (ended == child || (ended < 0 && errno != EINTR)) break;
    if (to_interrupt && error.text().find(options.interrupt_at) != std::string::npos) {
      kill(child, SIGINT);
      to_interrupt = false;
    }
    if (to_interrupt) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return {WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status), output.text(), error.text()};
}

}  // namespace weft::test
