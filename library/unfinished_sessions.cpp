// SPDX-License-Identifier: Apache-2.0
#include "library/unfinished_sessions.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "library/session_name.h"

namespace weft::library {

std::vector<UnfinishedSession> unfinished_sessions(const std::filesystem::path& sessions,
                                                   const std::string& rig, const std::string& fabric) {
  std::vector<UnfinishedSession> found;
  std::error_code error;
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(sessions, error)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != ".weft" || !session_folder(sessions, name)) continue;
    const auto written = std::filesystem::last_write_time(entry.path() / "session.json", error);
    Result<Session> session = read_session(entry.path());
    if (error || !session || session->state == "complete") continue;
    if (session->rig == rig && session->fabric == fabric)
      found.push_back({written, name, std::move(*session)});
  }
  std::ranges::sort(found, std::greater{}, &UnfinishedSession::written);
  return found;
}

}  // namespace weft::library
