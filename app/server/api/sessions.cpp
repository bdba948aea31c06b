// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/descriptions.h"
#include "library/session_name.h"

namespace weft::app {
namespace {

Json clipped_of(const Json& histogram) {
  return Json::array(
      {histogram["red"]["clipped"], histogram["green"]["clipped"], histogram["blue"]["clipped"]});
}

Json to_json(const Shot& shot, const std::string& name) {
  const std::string path = fmt::format("/api/v1/sessions/{}/frames/{}", name, shot.index);
  Json warnings = Json::array();
  if (shot.document.contains("warnings") && shot.document["warnings"].is_array()) {
    warnings = shot.document["warnings"];
  }
  return {{"index", shot.index},
          {"led", shot.led},
          {"role", library::name_of(shot.role)},
          {"file", shot.file},
          {"sha256", shot.sha256},
          {"exposure_us", shot.exposure_us},
          {"iso", shot.iso},
          {"f_number", shot.f_number},
          {"time", shot.time},
          {"thumbnail", path + "/thumbnail?sha256=" + shot.sha256},
          {"raw", path + "/raw?sha256=" + shot.sha256},
          {"warnings", warnings}};
}

/// The session with its frames, and what is known of each without decoding it; what is not known yet is made
/// in the background.
Result<Reply> one_session(const RigParts& parts, const Call& call) {
  const std::string& name = call.segments.at(0);
  const Result<Session> session = parts.sessions.find(name);
  if (!session) return session.error();
  Json frames = Json::array(), by_led = Json::array(), warnings = Json::array();
  bool whole = true;
  for (const Shot& shot : session->shots) {
    const FrameFile file = {session->path_of(shot), shot.sha256};
    const std::optional<Json> histogram = parts.pictures.ready_histogram(file);
    Json frame = to_json(shot, name);
    frame["histogram"] = histogram ? *histogram : Json();
    if (!histogram) {
      whole = false;
      if (library::lies_in(file.file, session->folder)) parts.pictures.prepare(file);
    } else if (shot.role == ShotRole::kLit) {
      by_led.push_back({{"led", shot.led}, {"clipped_rgb", clipped_of(*histogram)}});
    }
    for (const Json& warning : frame["warnings"]) warnings.push_back(warning);
    frames.push_back(std::move(frame));
  }
  return json_reply({{"name", name},
                     {"fabric", session->fabric},
                     {"rig", session->rig},
                     {"state", session->state},
                     {"resumable", parts.sessions.is_resumable(*session)},
                     {"cloth_height_mm", session->cloth_height_mm},
                     {"calibration", session->calibration_id},
                     {"frames", std::move(frames)},
                     {"histograms_complete", whole},
                     {"clipping_by_led", std::move(by_led)},
                     {"warnings", std::move(warnings)}});
}

Result<Reply> next_name(const RigParts& parts, const Call& call) {
  const auto fabric = call.query.find("fabric");
  const Result<std::string> name = library::next_session_name(
      parts.rig.scan.session_name, fabric == call.query.end() ? "cloth" : fabric->second, parts.rig.name,
      parts.rig.scan.sessions, std::chrono::system_clock::now());
  if (!name) return name.error();
  return json_reply({{"session", *name}, {"folder", (parts.rig.scan.sessions / (*name + ".weft")).string()}});
}

}  // namespace

Resource sessions_resource(const RigParts& parts) {
  return {
      {{"GET", "/api/v1/sessions",
        [&parts](const Call&) -> Result<Reply> {
          return json_reply({{"sessions", parts.sessions.list()}});
        }},
       {"GET", "/api/v1/sessions/{name}", [&parts](const Call& call) { return one_session(parts, call); }},
       {"GET", "/api/v1/next-name", [&parts](const Call& call) { return next_name(parts, call); }}},
      sessions_description()};
}

}  // namespace weft::app
