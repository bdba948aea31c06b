// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/batch/outside.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "core/files.h"
#include "core/solve.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

std::string quoted(const std::string& text) {
  std::string all = "'";
  for (const char c : text) all += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return all + "'";
}

}  // namespace

std::string filled(const std::string& command, const std::string& src, const std::string& dst) {
  std::string text;
  for (std::size_t i = 0; i < command.size();) {
    if (command.compare(i, 5, "{src}") == 0) {
      text += quoted(src), i += 5;
    } else if (command.compare(i, 5, "{dst}") == 0) {
      text += quoted(dst), i += 5;
    } else {
      text += command[i++];
    }
  }
  return text;
}

std::string run_outside(const std::string& command, const std::string& src, const std::string& dst) {
  const std::string text = filled(command, src, dst);
  const pid_t child = ::fork();
  if (child < 0) return system_reason(errno);
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGINT, SIG_DFL);
    ::dup2(STDERR_FILENO, STDOUT_FILENO);
    ::execl("/bin/sh", "sh", "-c", text.c_str(), nullptr);
    ::_exit(127);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return system_reason(errno);
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  return WIFEXITED(status) ? fmt::format("\"{}\" ended with {}", text, WEXITSTATUS(status))
                           : fmt::format("\"{}\" was ended by signal {}", text, WTERMSIG(status));
}

std::string store_outside(const std::string& command, const fs::path& solve, const std::string& dst) {
  const fs::path document = solve / kSolveProduct.document;
  const fs::path aside =
      solve.parent_path() / ("." + solve.filename().string() + "." + kSolveProduct.document);
  std::error_code failed;
  fs::rename(document, aside, failed);
  if (failed) return failed.message();
  std::string why = run_outside(command, solve.string(), dst);
  fs::rename(aside, document, failed);
  if (!why.empty()) return why;
  if (failed) return failed.message();
  return run_outside(command, document.string(), dst + "/" + kSolveProduct.document);
}

}  // namespace weft::app
