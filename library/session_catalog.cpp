// SPDX-License-Identifier: Apache-2.0
#include "library/session_catalog.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <functional>
#include <utility>

#include "core/error_json.h"
#include "core/files.h"
#include "core/iso_time.h"
#include "library/session_name.h"

namespace weft::library {
namespace {

constexpr const char* kEnding = ".weft";

}  // namespace

bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::error_code file_error, folder_error;
  const auto real_file = std::filesystem::canonical(file, file_error);
  const auto real_folder = std::filesystem::canonical(folder, folder_error);
  if (file_error || folder_error) return false;
  return std::mismatch(real_folder.begin(), real_folder.end(), real_file.begin(), real_file.end()).first ==
         real_folder.end();
}

const char* name_of(ShotRole role) {
  switch (role) {
    case ShotRole::kLit:
      return "lit";
    case ShotRole::kDark:
      return "dark";
    case ShotRole::kRepeat:
      return "repeat";
    case ShotRole::kBracket:
      return "bracket";
  }
  return "lit";
}

SessionCatalog::SessionCatalog(std::filesystem::path sessions, std::string rig)
    : sessions_(std::move(sessions)), rig_(std::move(rig)) {}

Json SessionCatalog::list() {
  const std::lock_guard lock(mutex_);
  std::map<std::string, Known> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(sessions_, error)) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() != kEnding || !session_folder(sessions_, name)) continue;
    const auto written = std::filesystem::last_write_time(entry.path() / "session.json", error);
    if (error) continue;
    const auto known = known_.find(name);
    const bool same = known != known_.end() && known->second.written == written;
    found[name] = same ? known->second : Known{written, summary_of(name, entry.path())};
  }
  known_ = std::move(found);
  std::vector<const Known*> newest_first;
  for (const auto& [name, known] : known_) newest_first.push_back(&known);
  std::ranges::stable_sort(newest_first, std::greater{}, &Known::written);
  Json list = Json::array();
  for (const Known* known : newest_first) list.push_back(known->summary);
  return list;
}

Json SessionCatalog::summary_of(const std::string& name, const std::filesystem::path& folder) const {
  std::error_code ignored;
  Json summary = {{"name", name}, {"state", "unreadable"}, {"resumable", false}, {"frames", 0}};
  const auto written =
      std::chrono::file_clock::to_sys(std::filesystem::last_write_time(folder / "session.json", ignored));
  summary["written"] = iso_time(std::chrono::duration<double>(written.time_since_epoch()).count());
  const Result<Session> session = read_session(folder);
  if (!session) {
    summary["error"] = json_of(session.error());
    return summary;
  }
  summary["state"] = session->state;
  summary["resumable"] = is_resumable(*session);
  summary["frames"] = session->shots.size();
  summary["fabric"] = session->fabric;
  summary["rig"] = session->rig;
  return summary;
}

Json SessionCatalog::resumable() {
  Json names = Json::array();
  for (const Json& session : list()) {
    if (session["resumable"] == true) names.push_back(session["name"]);
  }
  return names;
}

Result<Session> SessionCatalog::find(const std::string& name) const {
  Result<std::filesystem::path> folder = session_folder(sessions_, name);
  if (!folder) return std::move(folder).error();
  if (!is_there(*folder / "session.json")) {
    return Error{ErrorKind::kNoInput, "there is no such session", name, "",
                 "see /api/v1/sessions for those there are"};
  }
  return read_session(*folder);
}

Result<StoredFrame> SessionCatalog::frame(const std::string& name, const std::string& index) const {
  const Result<Session> session = find(name);
  if (!session) return session.error();
  int wanted = -1;
  const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), wanted);
  if (error != std::errc() || end != index.data() + index.size()) {
    return Error{ErrorKind::kUsage, "this is no number of a frame", index.substr(0, 20), "",
                 "use a frame's index, from 0"};
  }
  const auto shot = std::ranges::find(session->shots, wanted, &Shot::index);
  if (shot == session->shots.end() || !lies_in(session->path_of(*shot), session->folder)) {
    return Error{ErrorKind::kNoInput, "there is no such frame", fmt::format("{}, frame {}", name, wanted), "",
                 "see the session for the frames there are"};
  }
  return StoredFrame{session->path_of(*shot), shot->sha256};
}

}  // namespace weft::library
