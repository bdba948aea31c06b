// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "app/server/api/api.h"
#include "app/server/api/bodies/session_query.h"
#include "app/server/api/routes/session_choice.h"
#include "core/describe/field_json.h"
#include "library/catalogue/metadata.h"
#include "library/catalogue/session_files.h"
#include "library/catalogue/session_name.h"
#include "library/catalogue/session_verdict.h"
#include "solve/session/current.h"
#include "solve/session/left_out_shots.h"

namespace weft::app {
namespace {

Json clipped_of(const Json& histogram) {
  return Json::array(
      {histogram["red"]["clipped"], histogram["green"]["clipped"], histogram["blue"]["clipped"]});
}

Json to_json(const Shot& shot, const std::string& name) {
  const std::string path = fmt::format("/api/v1/sessions/{}/frames/{}", name, shot.index);
  return {{"index", shot.index},
          {"led", shot.led},
          {"role", name_of(shot.role)},
          {"file", shot.file},
          {"sha256", shot.sha256},
          {"exposure_us", shot.exposure_us},
          {"iso", shot.iso},
          {"f_number", shot.f_number},
          {"time", shot.time},
          {"polariser", name_of(shot.polariser)},
          {"superseded_by", shot.superseded_by ? Json(*shot.superseded_by) : Json()},
          {"thumbnail", path + "/thumbnail?sha256=" + shot.sha256},
          {"raw", path + "/raw?sha256=" + shot.sha256},
          {"warnings", warnings_of(shot)}};
}

/// The cloth relit by its current solve, else the first lit photograph: a path that names its bytes.
Json thumbnail_of(const library::Entry& entry) {
  const std::string path = "/api/v1/sessions/" + entry.name;
  if (!entry.current_solve.empty()) return fmt::format("{}/solves/{}/swatch.jpg", path, entry.current_solve);
  if (entry.lit_sha256.empty()) return nullptr;
  return fmt::format("{}/frames/{}/thumbnail?sha256={}", path, entry.lit_shot, entry.lit_sha256);
}

Result<Reply> find_sessions(const RigParts& parts, const Call& call) {
  const Result<library::Query> query = session_query(call.query);
  if (!query) return query.error();
  const Result<library::CataloguePage> page = parts.library.find(*query);
  if (!page) return page.error();
  Json sessions = Json::array();
  for (const library::Entry& entry : page->entries) {
    Json session = library::json_of(entry);
    session["resumable"] = is_resumable(parts.rig, entry.rig, entry.state);
    session["frames"] = entry.shots;
    session["thumbnail"] = thumbnail_of(entry);
    sessions.push_back(std::move(session));
  }
  return json_reply({{"sessions", std::move(sessions)},
                     {"total", page->total},
                     {"after", page->after ? Json(*page->after) : Json()}});
}

// The solve that maps are made of without a draft; null where there is none.
Json maps_of(const solve::SessionSolves& solves) {
  const Result<solve::ChoosableSolve> solve = solve::solve_for_maps(solves, "", false);
  if (!solve) return nullptr;
  return {{"solve", solve->id}, {"level", solve->level}, {"stale", why_stale(solves, solve->id)}};
}

/// The session with its frames, and what is known of each without decoding it; what is not known yet is made
/// in the background.
Result<Reply> one_session(const RigParts& parts, const Call& call) {
  const std::string& name = call.segments.at(0);
  const Result<Session> session = parts.library.session(name);
  if (!session) return session.error();
  Json frames = Json::array(), by_led = Json::array();
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
    frames.push_back(std::move(frame));
  }
  const solve::SessionSolves solves = solve::solves_of(*session);
  const Result<library::Metadata> said = library::metadata_of(*session);
  return json_reply({{"name", name},
                     {"folder", session->folder.string()},
                     {"said", said ? library::json_of(*said) : Json()},
                     {"left_out", solve::left_out(*session)},
                     {"current_solve", solves.current ? solves.current_one()->id : ""},
                     {"current_level", solves.current ? solves.current_one()->level : ""},
                     {"maps_of", maps_of(solves)},
                     {"fabric", session->fabric},
                     {"rig", session->rig},
                     {"state", session->state},
                     {"resumable", is_resumable(parts.rig, session->rig, session->state)},
                     {"cloth_height_mm", session->cloth_height_mm},
                     {"calibration", session->calibration_id},
                     {"other_exposures_us", other_exposures_us(*session)},
                     {"frames", std::move(frames)},
                     {"histograms_complete", whole},
                     {"clipping_by_led", std::move(by_led)},
                     {"verdict", object_of(library::verdict_of(*session))},
                     {"warnings", warnings_of(*session)}});
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
      {{"GET", "/api/v1/sessions", [&parts](const Call& call) { return find_sessions(parts, call); }},
       {"GET", "/api/v1/sessions/{name}", [&parts](const Call& call) { return one_session(parts, call); }},
       {"GET", "/api/v1/next-name", [&parts](const Call& call) { return next_name(parts, call); }}}};
}

}  // namespace weft::app
