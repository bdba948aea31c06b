// SPDX-License-Identifier: Apache-2.0
#include "library/run/outside.h"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "core/base/files.h"
#include "core/base/process.h"
#include "core/solve/solve.h"
#include "library/batch/farm.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

// Links to all files of a folder but one.
std::error_code link_all_but(const std::string& one, const fs::path& folder, const fs::path& to) {
  std::error_code failed;
  fs::create_directory(to, failed);
  for (fs::recursive_directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const fs::path into = to / fs::relative(entry->path(), folder, failed);
    if (failed || entry->path() == folder / one) continue;
    if (entry->is_directory(failed)) {
      fs::create_directory(into, failed);
    } else {
      fs::create_hard_link(entry->path(), into, failed);
    }
    if (failed) break;
  }
  return failed;
}

}  // namespace

std::string filled(const std::string& command, const std::string& src, const std::string& dst) {
  std::string text;
  for (std::size_t i = 0; i < command.size();) {
    if (command.compare(i, 5, "{src}") == 0) {
      text += shell_word(src), i += 5;
    } else if (command.compare(i, 5, "{dst}") == 0) {
      text += shell_word(dst), i += 5;
    } else {
      text += command[i++];
    }
  }
  return text;
}

std::string run_outside(const std::string& command, const std::string& src, const std::string& dst) {
  const std::string text = filled(command, src, dst);
  const auto child = ChildProcess::start({.command = {"/bin/sh", "-c", text},
                                          .input = STDIN_FILENO,
                                          .output = STDERR_FILENO,
                                          .ends_with_parent = true});
  if (!child) return child.error().why;
  const int code = (*child)->wait();
  if (code == 0) return "";
  const int killed_by = (*child)->killed_by();
  return killed_by == 0 ? fmt::format("\"{}\" ended with {}", text, code)
                        : fmt::format("\"{}\" was ended by signal {}", text, killed_by);
}

std::string store_outside(const std::string& command, const fs::path& solve, const std::string& dst) {
  // The command may be killed: what it sends lies beside the solve, which stays whole.
  const PartialFolder aside(solve);
  if (const std::error_code failed = link_all_but(kSolveProduct.document, solve, aside.path()))
    return failed.message();
  std::string why = run_outside(command, aside.path().string(), dst);
  if (!why.empty()) return why;
  return run_outside(command, (solve / kSolveProduct.document).string(), dst + "/" + kSolveProduct.document);
}

}  // namespace weft::library
