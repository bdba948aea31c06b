// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/bodies/scan_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "app/server/api/bodies/body_fields.h"
#include "core/describe/described_fields.h"
#include "core/describe/field_json.h"
#include "core/rig/cloth_kinds.h"
#include "library/catalogue/metadata.h"
#include "library/catalogue/session_name.h"

namespace weft::app {
namespace {

constexpr int kLongestName = 200;

Error refuse(const std::string& where, std::string why, std::string remedy) {
  return {ErrorKind::kUsage, "the request cannot be used", where, std::move(why), std::move(remedy)};
}

template <typename T>
bool are_different(const std::vector<T>& values) {
  return std::set<T>(values.begin(), values.end()).size() == values.size();
}

/// Which shots are taken.
void describe_shots(Fields& fields, ScanWish& wish) {
  fields.value({.name = "leds",
                .says = "LEDs, numbered from 1: 1,4,7; default all",
                .range = {1, static_cast<double>(wish.has.leds)},
                .fewest = 1,
                .most = wish.has.leds},
               wish.leds);
  fields.require(are_different(wish.leds), "leds", "must be different ones");
  fields.value(
      {.name = "bracket",
       .says = "Each LED once more at so many times the exposure: for cloth that one exposure cannot "
               "hold",
       .range = {0.001, 100}},
      wish.bracket);
  fields.value({.name = "polariser",
                .says = "How the films stand for each LED, crossed, parallel or crossed,parallel: one after "
                        "the other, and the first is solved; default [polariser] of the rig file",
                .words = wish.has.polariser},
               wish.polariser);
  fields.require(are_different(wish.polariser), "polariser", "must be different ones");
  fields.require(wish.polariser.empty() || !wish.has.polariser.empty(), "polariser",
                 "must be absent: the rig file has no [polariser]");
  fields.value({.name = "below",
                .says = "Do not light the cloth from below, though the rig file has [below]",
                .option = "!--no-below"},
               wish.below);
  fields.require(!wish.below || wish.has.below, "below", "must be false: the rig file has no [below]");
  fields.value(
      {.name = "blade",
       .says = "LED to be photographed once more at the end, with a straight edge above the cloth: "
               "the scan waits until it lies there, and its shadow tells the solve how light spreads "
               "in the cloth",
       .range = {1, static_cast<double>(wish.has.leds)}},
      wish.blade);
  fields.value({.name = "repeat",
                .says = "Do not light the first LED once more at the end, to see drift",
                .option = "!--no-repeat"},
               wish.repeat);
}

/// Which shots are worth taking, and what that is reckoned by.
void describe_price(Fields& fields, ScanWish& wish) {
  fields.value({.name = "explain",
                .says = "Photograph nothing: list shots that may be bought, their seconds and bytes by the "
                        "rig's last scan, and the degrees and share of the cloth that they tell",
                .said = Said::kAtThisMachine},
               wish.only_explains);
  fields.value({.name = "like",
                .says = "What the cloth is taken to be like by explain, to and within",
                .words = {kClothKinds.begin(), kClothKinds.end()}},
               wish.like);
  fields.value({.name = "to_deg",
                .says = "Choose LEDs, repeat, bracket and films: the cheapest that tell normals to so many "
                        "degrees",
                .range = kAboveZero},
               wish.aims.to_deg);
  fields.value({.name = "within_s",
                .says = "Choose them: the best that take so many seconds by the rig's last scan",
                .range = kAboveZero},
               wish.aims.within_s);
  for (const char* aim : {"to_deg", "within_s"}) {
    for (const char* chosen : {"repeat", "bracket", "polariser"}) fields.exclude(aim, chosen);
  }
}

/// As `request` has it.
ScanWish wish_of(const capture::ScanRequest& request, int leds) {
  ScanWish wish;
  wish.has = {leds, {}, request.below};
  for (const Polariser state : request.polariser.states) wish.has.polariser.emplace_back(name_of(state));
  wish.repeat = request.repeat;
  wish.below = request.below;
  return wish;
}

Result<ScanWish> read_wish(const Json& body, int leds, const capture::ScanRequest& otherwise) {
  return read_body(body, {"the request cannot be used", "a scan", "POST scan"}, wish_of(otherwise, leds));
}

void take_shots(const ScanWish& wish, capture::ScanRequest& request) {
  if (!wish.leds.empty()) request.leds = wish.leds;
  if (wish.bracket) request.bracket = wish.bracket;
  if (wish.blade) request.blade = wish.blade;
  request.repeat = wish.repeat;
  request.below = wish.below;
  if (wish.polariser.empty()) return;
  request.polariser.states.clear();
  for (const std::string& state : wish.polariser)
    request.polariser.states.push_back(polariser_of(state).value_or(Polariser::kNone));
}

}  // namespace

void describe(Fields& fields, ScanWish& wish) {
  fields.value({.name = "session",
                .says = "Session, NAME.weft, new or unfinished; default the one that the same request left "
                        "unfinished in the last hour, else a new one by the rig file's session_name",
                .path = PathTo::kSession,
                .option = "-o,--output"},
               wish.session);
  fields.value({.name = "fabric", .says = "Name of the cloth", .most = kLongestName, .is_sentence = true},
               wish.fabric);
  describe_exposure(fields, wish.exposure_us, {0, 1e9}, "metered for this cloth");
  fields.value({"any_exposure",
                "Go on though the first photograph at that exposure is half full or four stops too dark"},
               wish.any_exposure);
  fields.value({"iso", "Of the camera; default the rig file's", {1, 1e6}}, wish.iso);
  fields.value({"f_number", "Of the camera; default the rig file's", {0.5, 128}}, wish.f_number);
  describe_shots(fields, wish);
  fields.value({.name = "cloth_height_mm",
                .says = "Of the cloth's surface above the table, mm; default the rig file's",
                .range = {-1000, 1000},
                .option = "--height"},
               wish.cloth_height_mm);
  fields.value(
      {.name = "tilt_deg",
       .says = "The cloth lies on a wedge that tilts it by so many degrees: a second pose, whose lobe "
               "weft solve --second-pose seeks together with the first one's; default 0",
       .range = {0, kMostTilt_deg}},
      wish.tilt_deg);
  fields.value({.name = "downhill_deg",
                .says = "With tilt: azimuth to which it falls, degrees from x towards y; default 0",
                .range = {-360, 360}},
               wish.downhill_deg);
  fields.need("downhill_deg", "tilt_deg");
  fields.value({.name = "metadata",
                .says = "KEY=VALUE to keep with the session: id, weight, side, notes",
                .is_said_again = true},
               wish.metadata);
  fields.value({.name = "accept_moved",
                .says = "Scan although the last check of the calibration did not pass: the reason, which is "
                        "kept",
                .most = kLongestName,
                .is_sentence = true},
               wish.accept_moved);
  fields.value({.name = "copy",
                .says = "Make no second copy, though the rig file names a folder for one",
                .option = "!--no-copy"},
               wish.copy);
  fields.value({.name = "request_id",
                .says = "The same as that of the last scan is that scan: a click that comes twice",
                .most = kLongestName,
                .said = Said::kToServer,
                .is_sentence = true},
               wish.request_id);
  describe_price(fields, wish);
  fields.value({"dry_run", "Only say which session would be made or gone on with"}, wish.dry_run);
}

Result<Json> parse_body(std::string_view body) {
  if (body.find_first_not_of(" \t\r\n") == std::string_view::npos) return Json::object();
  auto [json, why] = parse_json(body);
  if (!why.empty()) return refuse("body", why, "send one JSON object, as in {\"fabric\": \"satin\"}");
  if (!json.is_object())
    return refuse("body", "is no JSON object", "send one, as in {\"fabric\": \"satin\"}");
  return json;
}

Result<std::string> session_in_body(const Json& body) {
  const Json name = body.value("session", Json());
  if (name.is_null()) return std::string();
  if (!name.is_string()) return refuse("session", "is no text", "give the name of a session");
  const auto& text = name.get_ref<const std::string&>();
  if (library::is_session_name(text)) return text;
  if (text.size() > library::kMostSessionNameBytes) {
    return refuse(
        "session",
        fmt::format("is {} bytes long, longer than {}", text.size(), library::kMostSessionNameBytes),
        "give a shorter name");
  }
  return refuse("session", "is " + name.dump(), "give a name of letters, digits, '.', '_' and '-'");
}

capture::ScanRequest request_of_rig(const capture::Rig& rig) {
  capture::ScanRequest request;
  request.rig = rig.name;
  request.calibration = capture::calibration_now(rig);
  request.cloth_height_mm = rig.scan.cloth_height_mm;
  request.exposure = {rig.scan.exposure_us.value_or(0), rig.scan.iso, rig.scan.f_number};
  request.copy = rig.scan.copy;
  request.leds.resize(static_cast<std::size_t>(rig.leds));
  std::iota(request.leds.begin(), request.leds.end(), 1);
  request.polariser = {rig.polariser.states, rig.polariser.states.size() > 1, rig.polariser.settle_s};
  request.below = rig.below.has_value();
  if (rig.below) request.below_us = rig.below->exposure_us.value_or(0);
  return request;
}

capture::ScanRequest request_of_session(const Session& session, const capture::Rig& rig) {
  capture::ScanRequest request = request_of_rig(rig);
  request.fabric = session.fabric;
  request.cloth_height_mm = session.cloth_height_mm;
  request.pose = session.pose;
  if (session.document.contains("metadata")) request.metadata = session.document["metadata"];
  if (!session.document.contains("plan") || !session.document["plan"].is_object()) return request;
  ScanWish begun = wish_of(request, rig.leds);
  begun.below = false;
  JsonReader plan(session.document["plan"], "plan");
  describe_shots(plan, begun);
  request.polariser.states.clear();
  request.below = false;
  if (plan.status()) take_shots(begun, request);
  return request;
}

Result<ShotAims> read_shot_aims(const Json& body, int leds, const capture::ScanRequest& otherwise) {
  const Result<ScanWish> wish = read_wish(body, leds, otherwise);
  if (!wish) return wish.error();
  const auto& cloths = calibration::planned_cloths();
  return ShotAims{wish->aims, *std::ranges::find(cloths, wish->like, &calibration::NamedCloth::name)};
}

Result<capture::ScanRequest> read_scan_body(const Json& body, int leds,
                                            const capture::ScanRequest& otherwise) {
  if (const Result<std::string> name = session_in_body(body); !name) return name.error();
  const Result<ScanWish> wish = read_wish(body, leds, otherwise);
  if (!wish) return wish.error();
  capture::ScanRequest request = otherwise;
  if (!wish->fabric.empty()) request.fabric = wish->fabric;
  request.cloth_height_mm = wish->cloth_height_mm.value_or(request.cloth_height_mm);
  request.pose.tilt_deg = wish->tilt_deg.value_or(request.pose.tilt_deg);
  request.pose.downhill_deg = wish->downhill_deg.value_or(request.pose.downhill_deg);
  request.exposure.exposure_us = wish->exposure_us.value_or(request.exposure.exposure_us);
  request.any_exposure = wish->any_exposure;
  request.exposure.iso = wish->iso.value_or(request.exposure.iso);
  request.exposure.f_number = wish->f_number.value_or(request.exposure.f_number);
  if (!wish->metadata.empty()) {
    if (Result<void> ok = library::check_new_metadata(wish->metadata); !ok) return std::move(ok).error();
    request.metadata = wish->metadata;
  }
  take_shots(*wish, request);
  if (!wish->accept_moved.empty()) request.accepted_moved = {{"why", wish->accept_moved}};
  if (!wish->copy) request.copy.clear();
  return request;
}

}  // namespace weft::app
