// SPDX-License-Identifier: Apache-2.0
#include "core/rig/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "core/describe/field_json.h"
#include "core/rig/exposure_words.h"

namespace weft {
namespace {

constexpr const char* kSessionSchema = "weft.session";
constexpr std::array<const char*, 6> kRoles = {"lit", "dark", "repeat", "bracket", "below", "blade"};
constexpr std::array<const char*, 3> kPolarisers = {"none", "parallel", "crossed"};

bool stays_inside(const std::filesystem::path& file) {
  if (file.empty() || file.is_absolute()) return false;
  return std::none_of(file.begin(), file.end(),
                      [](const std::filesystem::path& part) { return part == ".."; });
}

// Whether the session has a shot with a blade, which its document as it was read has not.
bool adds_blade(const Session& session) {
  const auto shots = session.document.find("shots");
  const bool is_known = shots != session.document.end() && std::ranges::any_of(*shots, [](const Json& shot) {
                          return shot.value("role", "") == name_of(ShotRole::kBlade);
                        });
  return !is_known && std::ranges::find(session.shots, ShotRole::kBlade, &Shot::role) != session.shots.end();
}

}  // namespace

void describe(Fields& fields, Shot& s) {
  fields.keep(s.document);
  fields.value({"index", "Order of capture, from 0", kAnyNumber, kMustSay}, s.index);
  fields.value({"led", "LED that was lit, from 1; 0: none", kNotNegative, kMustSay}, s.led);
  fields.choice({"role", "What the photograph is for", kAnyNumber, kMustSay}, s.role, kRoles);
  fields.value({"file", "Relative to the session", kAnyNumber, kMustSay}, s.file);
  fields.value({"sha256", "Of the file's bytes"}, s.sha256);
  fields.value(
      {"exposure_us", "How long it was exposed, microseconds; 0: not known, of photographs that no rig took",
       kNotNegative, kMustSay},
      s.exposure_us);
  fields.value({"iso", "Speed; 0: not known", kNotNegative, kMustSay}, s.iso);
  fields.value({"f_number", "Aperture", kAnyNumber, kMustSay}, s.f_number);
  fields.value({"time", "When, ISO 8601", kAnyNumber, kUnlessEmpty}, s.time);
  fields.choice({"polariser", "How the film before the camera stands to that before the lights", kAnyNumber,
                 kUnlessEmpty},
                s.polariser, kPolarisers);
  fields.value({"superseded_by", "Index of the shot of the same LED and role that stands for it"},
               s.superseded_by);
  fields.require(stays_inside(s.file), "file", "must be a path inside the session");
  fields.require(s.role != ShotRole::kBelow || s.led == 0, "led", "must be 0 for a shot of the light below");
  fields.require(s.role != ShotRole::kLit || s.led != 0, "led", "must be above 0 for a lit shot");
  fields.require(s.role != ShotRole::kBlade || s.led != 0, "led", "must be above 0 for a shot with a blade");
}

void describe(Fields& fields, Films& f) {
  fields.value(
      {"leak", "Of light that keeps its polarisation, through crossed films over parallel ones", {0, 0.5}},
      f.leak);
  fields.value({"scattered",
                "Scattered light that passes them over what the calibration's lights say",
                {kAboveZero.least, 1}},
               f.scattered);
}

void describe(Fields& fields, ClothPose& p) {
  fields.value({"tilt_deg", "Between the cloth and the table, degrees", {0, kMostTilt_deg}}, p.tilt_deg);
  fields.value({"downhill_deg", "Azimuth to which it falls, from x towards y, degrees", {-360, 360}},
               p.downhill_deg);
}

void describe(Fields& fields, Session& s) {
  fields.keep(s.document);
  fields.value({"fabric", "What was scanned"}, s.fabric);
  fields.value({"cloth_height_mm", "Of the cloth's surface above the table, mm", kAnyNumber, kMustSay},
               s.cloth_height_mm);
  fields.value({"rig", "Its name", kAnyNumber, kMustSay}, s.rig);
  fields.value({"calibration", "Its id", kAnyNumber, kMustSay}, s.calibration_id);
  fields.value({"state", "\"capturing\" until the last frame has landed", kAnyNumber, kMustSay}, s.state);
  fields.list({"shots", "One an exposure", kAnyNumber, kMustSay}, s.shots);
  fields.object({"films", "Of shots that were taken through polarisers", kAnyNumber, kUnlessEmpty}, s.films);
  fields.object({"pose", "Of a cloth that does not lie flat on the table", kAnyNumber, kUnlessEmpty}, s.pose);
  fields.value(
      {"shutter_travel_s", "From the exposure of the first row to that of the last, s", {0, 1}, kUnlessEmpty},
      s.shutter_travel_s);
  fields.object(
      {"photographs", "That no rig took: how they and their lights are read", kAnyNumber, kUnlessEmpty},
      s.photographs);
}

namespace {

Result<void> check_shots(const Session& session, const std::string& where) {
  const auto refuse = [&](std::string why, std::string remedy) {
    return Error{ErrorKind::kBadData, "session cannot be used", where, std::move(why), std::move(remedy)};
  };
  std::set<std::pair<int, Polariser>> lit_leds;
  const Shot* first = nullptr;
  int darks = 0;
  for (const Shot& shot : session.shots) {
    if (session.is_of_rig() && (shot.exposure_us == 0 || shot.iso == 0))
      return refuse(fmt::format("{} has no exposure or no ISO", shot.file), "write what it was taken with");
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
    if (!session.is_of_rig()) continue;
    if (shot.exposure_us != first->exposure_us || shot.iso != first->iso ||
        shot.f_number != first->f_number) {
      return refuse(fmt::format("{} was taken at {}, ISO {}, f/{} and {} at {}, ISO {}, f/{}", first->file,
                                exposure_words(first->exposure_us), first->iso, first->f_number, shot.file,
                                exposure_words(shot.exposure_us), shot.iso, shot.f_number),
                    "scan again with one exposure for all shots, mark an odd lit one as bracket, or take an "
                    "odd dark one out: then black stands in its place");
    }
  }
  return {};
}

}  // namespace

const char* name_of(ShotRole role) {
  return kRoles[static_cast<std::size_t>(role)];
}

std::optional<Polariser> polariser_of(std::string_view name) {
  const auto found = std::ranges::find(kPolarisers, name);
  if (found == kPolarisers.end()) return std::nullopt;
  return static_cast<Polariser>(found - kPolarisers.begin());
}

const char* name_of(Polariser polariser) {
  return kPolarisers[static_cast<std::size_t>(polariser)];
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
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored) && !ignored) {
    const bool is_folder = std::filesystem::is_directory(folder, ignored);
    return Error{ErrorKind::kNoInput, "there is no such session", folder.string(),
                 is_folder ? "it holds no session.json" : "there is no such folder",
                 "name a session's folder, NAME.weft; photographs are solved by weft solve --photos"};
  }
  const Result<Json> document = read_json(file, kSessionSchema, 1);
  if (!document) return document.error();
  Result<Session> session = read_fields<Session>(*document, file.string());
  if (!session) return session;
  session->folder = folder;
  if (Result<void> ok = check_shots(*session, file.string()); !ok) return std::move(ok).error();
  return session;
}

Result<void> write_session(const Session& session) {
  Json document = session.document.is_object() ? session.document : Json::object();
  if (!document.contains("schema")) document["schema"] = fmt::format("{}/1", kSessionSchema);
  if (session.films != Films() && !document.contains("films"))
    document["schema"] = fmt::format("{}/1.3", kSessionSchema);
  if (session.pose != ClothPose() && !document.contains("pose"))
    document["schema"] = fmt::format("{}/1.4", kSessionSchema);
  if (session.photographs && !document.contains("photographs"))
    document["schema"] = fmt::format("{}/1.6", kSessionSchema);
  if (session.shutter_travel_s > 0 && !document.contains("shutter_travel_s"))
    document["schema"] = fmt::format("{}/1.7", kSessionSchema);
  if (adds_blade(session)) document["schema"] = fmt::format("{}/1.8", kSessionSchema);
  Session written = session;
  written.document = std::move(document);
  Json json;
  write_fields(json, std::move(written));
  return write_json(session.folder / "session.json", json);
}

}  // namespace weft
