// SPDX-License-Identifier: Apache-2.0
#include "core/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

namespace weft {
namespace {

constexpr const char* kSessionSchema = "weft.session";
constexpr std::array<std::pair<ShotRole, const char*>, 5> kRoles = {{{ShotRole::kLit, "lit"},
                                                                     {ShotRole::kDark, "dark"},
                                                                     {ShotRole::kRepeat, "repeat"},
                                                                     {ShotRole::kBracket, "bracket"},
                                                                     {ShotRole::kBelow, "below"}}};
constexpr std::array<std::pair<Polariser, const char*>, 3> kPolarisers = {
    {{Polariser::kNone, "none"}, {Polariser::kParallel, "parallel"}, {Polariser::kCrossed, "crossed"}}};

bool stays_inside(const std::filesystem::path& file) {
  if (file.empty() || file.is_absolute()) return false;
  return std::none_of(file.begin(), file.end(),
                      [](const std::filesystem::path& part) { return part == ".."; });
}

Result<Shot> read_shot(const Json& json, const std::string& where) {
  JsonFields fields(json, where);
  Shot shot;
  shot.index = fields.integer("index");
  shot.led = fields.integer("led");
  shot.file = fields.text("file");
  shot.sha256 = fields.text_or("sha256", "");
  shot.exposure_us = fields.number("exposure_us");
  shot.iso = fields.number("iso");
  shot.f_number = fields.number("f_number");
  shot.time = fields.text_or("time", "");
  const std::string role = fields.text("role");
  const auto* known =
      std::ranges::find(kRoles, role, [](const auto& r) { return std::string_view(r.second); });
  if (known == kRoles.end()) {
    fields.reject("role", fmt::format("is \"{}\"; lit, dark, repeat, bracket or below was expected", role));
  } else {
    shot.role = known->first;
  }
  const std::string polariser = fields.text_or("polariser", "none");
  const std::optional<Polariser> state = polariser_of(polariser);
  if (!state) {
    fields.reject("polariser", fmt::format("is \"{}\"; none, parallel or crossed was expected", polariser));
  } else {
    shot.polariser = *state;
  }
  if (json.contains("superseded_by")) shot.superseded_by = fields.integer("superseded_by");
  if (!stays_inside(shot.file)) fields.reject("file", "must be a path inside the session");
  if (shot.exposure_us <= 0) fields.reject("exposure_us", "must be above 0");
  if (shot.iso <= 0) fields.reject("iso", "must be above 0");
  if (shot.led < 0) fields.reject("led", "must be 0 (none) or a LED's number");
  if (shot.role == ShotRole::kBelow && shot.led != 0) {
    fields.reject("led", "must be 0 for a shot of the light below");
  }
  if (shot.role == ShotRole::kLit && shot.led == 0) fields.reject("led", "must be above 0 for a lit shot");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  shot.document = json;
  return shot;
}

Result<Films> read_films(const Json& films, const std::string& where) {
  JsonFields fields(films, where);
  Films read;
  read.leak = fields.optional_number("leak").value_or(read.leak);
  read.scattered = fields.optional_number("scattered").value_or(read.scattered);
  if (!(read.leak >= 0 && read.leak <= 0.5)) fields.reject("leak", "must be from 0 to 0.5");
  if (!(read.scattered > 0 && read.scattered <= 1))
    fields.reject("scattered", "must be above 0 and at most 1");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return read;
}

Result<ClothPose> read_pose(const Json& pose, const std::string& where) {
  JsonFields fields(pose, where);
  ClothPose read;
  read.tilt_deg = fields.optional_number("tilt_deg").value_or(read.tilt_deg);
  read.downhill_deg = fields.optional_number("downhill_deg").value_or(read.downhill_deg);
  if (!(read.tilt_deg >= 0 && read.tilt_deg <= kMostTilt_deg))
    fields.reject("tilt_deg", fmt::format("must be from 0 to {}", kMostTilt_deg));
  if (!(std::abs(read.downhill_deg) <= 360)) fields.reject("downhill_deg", "must be from -360 to 360");
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  return read;
}

Result<void> check_shots(const Session& session, const std::string& where) {
  const auto refuse = [&](std::string why, std::string remedy) {
    return Error{ErrorKind::kBadData, "session cannot be used", where, std::move(why), std::move(remedy)};
  };
  std::set<std::pair<int, Polariser>> lit_leds;
  const Shot* first = nullptr;
  int darks = 0;
  for (const Shot& shot : session.shots) {
    if (shot.superseded_by) {
      const auto other = std::ranges::find(session.shots, *shot.superseded_by, &Shot::index);
      if (other == session.shots.end() || other->index <= shot.index || other->led != shot.led ||
          other->role != shot.role) {
        return refuse(fmt::format("shot {} is superseded by {}, which is no later shot of its LED and role",
                                  shot.index, *shot.superseded_by),
                      "name the shot that stands for it, or take \"superseded_by\" out");
      }
      continue;
    }
    if (shot.role != ShotRole::kLit && shot.role != ShotRole::kDark) continue;
    if (shot.role == ShotRole::kLit && !lit_leds.insert({shot.led, shot.polariser}).second) {
      return refuse(fmt::format("LED {} has two lit shots", shot.led),
                    "keep one of them as lit and mark the other as repeat");
    }
    if (shot.role == ShotRole::kDark && ++darks > 1) {
      return refuse("there are two dark shots", "keep one of them");
    }
    if (first == nullptr) first = &shot;
    if (shot.exposure_us != first->exposure_us || shot.iso != first->iso ||
        shot.f_number != first->f_number) {
      return refuse(fmt::format("{} was taken at {} us, ISO {}, f/{} and {} at {} us, ISO {}, f/{}",
                                first->file, first->exposure_us, first->iso, first->f_number, shot.file,
                                shot.exposure_us, shot.iso, shot.f_number),
                    "scan again with one exposure for all shots, or mark the odd one as bracket");
    }
  }
  return {};
}

Json to_json(const Shot& shot) {
  Json json = shot.document.is_object() ? shot.document : Json::object();
  json["index"] = shot.index;
  json["led"] = shot.led;
  json["role"] = name_of(shot.role);
  json["file"] = shot.file;
  json["sha256"] = shot.sha256;
  json["exposure_us"] = shot.exposure_us;
  json["iso"] = shot.iso;
  json["f_number"] = shot.f_number;
  if (!shot.time.empty()) json["time"] = shot.time;
  if (shot.polariser != Polariser::kNone) json["polariser"] = name_of(shot.polariser);
  if (shot.superseded_by) json["superseded_by"] = *shot.superseded_by;
  return json;
}

}  // namespace

const char* name_of(ShotRole role) {
  return std::ranges::find(kRoles, role, &std::pair<ShotRole, const char*>::first)->second;
}

std::optional<Polariser> polariser_of(std::string_view name) {
  const auto found =
      std::ranges::find(kPolarisers, name, [](const auto& p) { return std::string_view(p.second); });
  return found == kPolarisers.end() ? std::nullopt : std::optional(found->first);
}

const char* name_of(Polariser polariser) {
  return std::ranges::find(kPolarisers, polariser, &std::pair<Polariser, const char*>::first)->second;
}

const Shot* Session::dark() const {
  const auto found = std::ranges::find_if(
      shots, [](const Shot& s) { return s.role == ShotRole::kDark && !s.superseded_by; });
  return found == shots.end() ? nullptr : &*found;
}

std::vector<const Shot*> Session::lit() const {
  const auto first = std::ranges::find(shots, ShotRole::kLit, &Shot::role);
  return first == shots.end() ? std::vector<const Shot*>() : lit(first->polariser);
}

std::vector<const Shot*> Session::lit(Polariser polariser) const {
  std::vector<const Shot*> lit;
  for (const Shot& shot : shots) {
    if (shot.role == ShotRole::kLit && shot.polariser == polariser && !shot.superseded_by)
      lit.push_back(&shot);
  }
  std::ranges::sort(lit, {}, &Shot::led);
  return lit;
}

Result<Session> read_session(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "session.json";
  Result<Json> document = read_json(file, kSessionSchema, 1);
  if (!document) return std::move(document).error();
  JsonFields fields(*document, file.string());
  Session session;
  session.folder = folder;
  session.fabric = fields.text_or("fabric", "");
  session.cloth_height_mm = fields.number("cloth_height_mm");
  session.rig = fields.text("rig");
  session.calibration_id = fields.text("calibration");
  session.state = fields.text("state");
  const Json& shots = fields.list("shots");
  const Json films = fields.has("films") ? fields.object("films") : Json::object();
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  Result<Films> read = read_films(films, file.string() + ": films");
  if (!read) return std::move(read).error();
  session.films = *read;
  Result<ClothPose> pose =
      read_pose(fields.has("pose") ? fields.object("pose") : Json::object(), file.string() + ": pose");
  if (!pose) return std::move(pose).error();
  session.pose = *pose;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    Result<Shot> shot = read_shot(shots[i], fmt::format("{}: shot {}", file.string(), i));
    if (!shot) return std::move(shot).error();
    session.shots.push_back(std::move(*shot));
  }
  if (Result<void> ok = check_shots(session, file.string()); !ok) return std::move(ok).error();
  session.document = std::move(*document);
  return session;
}

Result<void> write_session(const Session& session) {
  Json document = session.document.is_object() ? session.document : Json::object();
  if (!document.contains("schema")) document["schema"] = std::string(kSessionSchema) + "/1";
  document["fabric"] = session.fabric;
  document["cloth_height_mm"] = session.cloth_height_mm;
  document["rig"] = session.rig;
  document["calibration"] = session.calibration_id;
  document["state"] = session.state;
  Json shots = Json::array();
  for (const Shot& shot : session.shots) shots.push_back(to_json(shot));
  document["shots"] = std::move(shots);
  if (session.films != Films()) {
    if (!document.contains("films")) document["schema"] = std::string(kSessionSchema) + "/1.3";
    document["films"] = {{"leak", session.films.leak}, {"scattered", session.films.scattered}};
  }
  if (!session.pose.is_level()) {
    if (!document.contains("pose")) document["schema"] = std::string(kSessionSchema) + "/1.4";
    document["pose"] = {{"tilt_deg", session.pose.tilt_deg}, {"downhill_deg", session.pose.downhill_deg}};
  }
  return write_json(session.folder / "session.json", document);
}

}  // namespace weft
