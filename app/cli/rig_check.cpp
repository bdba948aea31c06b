// SPDX-License-Identifier: Apache-2.0
#include "app/cli/rig_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "calibration/run/rig_look.h"
#include "capture/rig.h"
#include "core/describe/error_json.h"
#include "core/describe/field_json.h"
#include "library/run/survey.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using calibration::RigLook;

struct CheckArguments {
  std::vector<fs::path> sessions;  ///< or folders of some; empty: the rig's last scan
  fs::path rig, calibration;
  bool strict = false;
};

/// By the time of their first photograph; what has none is left out.
Result<std::vector<Session>> sessions_of(const CheckArguments& a) {
  std::vector<std::string> folders;
  for (const fs::path& folder : a.sessions) folders.push_back(folder.string());
  if (folders.empty()) {
    const Result<capture::Rig> rig = capture::read_rig(find_rig(a.rig));
    if (!rig) return rig.error();
    folders.push_back(rig->scan.sessions.string());
  }
  const Result<std::vector<fs::path>> found = library::sessions_below(folders);
  if (!found) return found.error();
  std::vector<Session> sessions;
  for (const fs::path& folder : *found) {
    Result<Session> session = read_session(folder);
    if (!session && found->size() == 1) return std::move(session).error();
    if (session && !session->shots.empty()) sessions.push_back(std::move(*session));
  }
  std::ranges::stable_sort(sessions, {}, [](const Session& each) { return each.shots.front().time; });
  if (a.sessions.empty() && sessions.size() > 1) sessions.erase(sessions.begin(), sessions.end() - 1);
  if (!sessions.empty()) return sessions;
  return Error{ErrorKind::kNoInput, "there is no scan to look at", folders.front(), "",
               "scan something, or name sessions"};
}

Result<RigLook> look_of(const Session& session, const CheckArguments& a, const CommonArguments& common) {
  ProgressLine line(common.quiet);
  Result<RigLook> look =
      calibration::look_at_scan(session, {common.threads, stop_on_signal(), line.callback()});
  if (!look || a.calibration.empty()) return look;
  return calibration::look_by_another(*look, a.calibration);
}

Json json_of(const Session& session, const RigLook& look) {
  Json json = {{"session", session.folder.string()}};
  write_fields(json, look);
  return json;
}

std::string line_of(const RigLook& look) {
  return look.says + (look.action.empty() ? "" : "; to do: " + look.action);
}

Result<int> check(const CheckArguments& a, const CommonArguments& common) {
  const Result<std::vector<Session>> sessions = sessions_of(a);
  if (!sessions) return sessions.error();
  Json looks = Json::array();
  bool is_last_bad = false;
  std::optional<Error> failed;
  for (const Session& session : *sessions) {
    const Result<RigLook> look = look_of(session, a, common);
    if (!look && look.error().kind == ErrorKind::kInterrupted) return look.error();
    const std::string name = session.folder.stem().string();
    if (!look) {
      failed = look.error();
      if (common.json) looks.push_back({{"session", session.folder.string()}, {"error", json_of(*failed)}});
      if (sessions->size() > 1) note(fmt::format("{}  {}", name, failed->message()));
      continue;
    }
    is_last_bad = look->is_bad();
    if (common.json) {
      looks.push_back(json_of(session, *look));
    } else {
      print(fmt::format("{}  {}", name, line_of(*look)));
    }
  }
  if (failed && sessions->size() == 1) return *failed;
  if (common.json) print_json({{"looks", std::move(looks)}});
  return a.strict && is_last_bad ? kDoneWithWarnings : kDone;
}

}  // namespace

Run add_rig_check(Options& options) {
  const auto a = std::make_shared<CheckArguments>();
  options.add("sessions", &a->sessions,
              "Sessions, or folders that hold some at any depth; default the rig's last scan");
  add_rig_file(options, a->rig);
  options.add("--calibration", &a->calibration,
              "Hold what they show against this one; default each session's own");
  options.add_flag("--strict", &a->strict, "Exit code 2 where the last of them says that the rig moved");
  return [a](const CommonArguments& common) { return check(*a, common); };
}

std::optional<SeenRig> last_seen(const capture::Rig& rig) {
  const fs::path folder = calibration::looked_at_last(rig.scan.sessions);
  const Result<Session> session = read_session(folder);
  if (!session) return std::nullopt;
  std::optional<RigLook> look = calibration::kept_look(*session);
  if (!look) return std::nullopt;
  return SeenRig{folder.stem().string(), calibration::look_by_now(std::move(*look), rig.scan.calibration)};
}

}  // namespace weft::app
