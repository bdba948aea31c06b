// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/folders_with.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/base/files.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

}  // namespace

Result<std::vector<fs::path>> folders_with(const fs::path& root, const char* name) {
  std::vector<fs::path> found;
  std::error_code failed;
  fs::recursive_directory_iterator walk(root, fs::directory_options::skip_permission_denied, failed), end;
  for (; !failed && walk != end; walk.increment(failed)) {
    std::error_code ignored;
    if (!walk->is_directory(ignored)) continue;
    if (is_there(walk->path() / name)) found.push_back(walk->path());
    if (is_there(walk->path() / "session.json")) walk.disable_recursion_pending();
  }
  if (failed) return cannot_read(root, failed.value());
  if (is_there(root / name)) found.push_back(root);
  std::sort(found.begin(), found.end());
  return found;
}

Result<std::vector<Session>> sessions_below(const fs::path& root) {
  if (is_there(root / "session.json")) {
    Result<Session> one = read_session(root);
    if (!one) return std::move(one).error();
    return std::vector{std::move(*one)};
  }
  const Result<std::vector<fs::path>> folders = folders_with(root, "session.json");
  if (!folders) return folders.error();
  std::vector<Session> sessions;
  for (const fs::path& folder : *folders) {
    Result<Session> session = read_session(folder);
    if (session && !session->shots.empty()) sessions.push_back(std::move(*session));
  }
  std::ranges::stable_sort(sessions, {}, [](const Session& session) { return session.shots.front().time; });
  return sessions;
}

}  // namespace weft::calibration
