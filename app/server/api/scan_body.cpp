// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/scan_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <utility>

#include "core/text.h"
#include "library/metadata.h"
#include "library/session_name.h"

namespace weft::app {
namespace {

constexpr std::size_t kMostFabricBytes = 200;
constexpr std::array<std::string_view, 18> kFields = {
    "session",      "fabric",    "cloth_height_mm", "metadata",   "exposure_us", "iso",
    "f_number",     "leds",      "repeat",          "bracket",    "copy",        "dry_run",
    "accept_moved", "polariser", "below",           "request_id", "tilt_deg",    "downhill_deg"};

Error refuse(const std::string& where, std::string why, std::string remedy) {
  return {ErrorKind::kUsage, "the request cannot be used", where, std::move(why), std::move(remedy)};
}

/// Reads the fields of one object; the first that is wrong is remembered, and the rest is not looked at.
class Fields {
 public:
  explicit Fields(const Json& object) : object_(object) {}

  template <typename Read>
  void read(const char* key, const char* allowed, const Read& take) {
    const auto at = object_.find(key);
    if (error_ || at == object_.end() || at->is_null()) return;
    if (!take(*at)) {
      error_ = refuse(key, "is " + at->dump().substr(0, 60), fmt::format("give {}", allowed));
    }
  }
  void number(const char* key, const char* allowed, double least, double most, double& value) {
    read(key, allowed, [&](const Json& json) {
      if (!json.is_number() || !(json.get<double>() >= least && json.get<double>() <= most)) return false;
      value = json.get<double>();
      return true;
    });
  }
  void text(const char* key, const char* allowed, std::string& value, bool (*fits)(const std::string&)) {
    read(key, allowed, [&](const Json& json) {
      if (!json.is_string() || !fits(json.get_ref<const std::string&>())) return false;
      value = json.get<std::string>();
      return true;
    });
  }
  void flag(const char* key, bool& value) {
    read(key, "true or false", [&](const Json& json) {
      if (json.is_boolean()) value = json.get<bool>();
      return json.is_boolean();
    });
  }
  const std::optional<Error>& error() const { return error_; }

 private:
  const Json& object_;
  std::optional<Error> error_;
};

std::optional<Error> unknown_field(const Json& body) {
  for (const auto& [key, value] : body.items()) {
    if (std::ranges::find(kFields, key) != kFields.end()) continue;
    const auto nearest = std::ranges::min_element(kFields, {}, [&name = key](std::string_view field) {
      return edit_distance(name.substr(0, 60), field);
    });
    return refuse(key.substr(0, 60), "there is no such field", fmt::format("did you mean '{}'", *nearest));
  }
  return std::nullopt;
}

bool is_fabric(const std::string& text) {
  return !text.empty() && text.size() <= kMostFabricBytes &&
         std::ranges::none_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

bool take_leds(const Json& json, int most, std::vector<int>& leds) {
  if (!json.is_array() || json.empty() || json.size() > static_cast<std::size_t>(most)) return false;
  std::set<int> seen;
  leds.clear();
  for (const Json& led : json) {
    const bool fits = led.is_number_integer() && led.get<double>() >= 1 && led.get<double>() <= most;
    if (!fits || !seen.insert(led.get<int>()).second) return false;
    leds.push_back(led.get<int>());
  }
  return true;
}

bool take_states(const Json& json, const std::vector<Polariser>& possible, std::vector<Polariser>& states) {
  if (!json.is_array() || json.empty() || json.size() > possible.size()) return false;
  states.clear();
  for (const Json& name : json) {
    const auto state = name.is_string() ? polariser_of(name.get_ref<const std::string&>()) : std::nullopt;
    if (!state || std::ranges::count(possible, *state) == 0 || std::ranges::count(states, *state) > 0)
      return false;
    states.push_back(*state);
  }
  return true;
}

/// Which shots are taken; the rig has no other polariser and light below than `rig` asks for.
void read_plan(Fields& fields, int most_leds, const capture::ScanRequest& rig,
               capture::ScanRequest& request) {
  const std::string leds = fmt::format("different numbers from 1 to {}", most_leds);
  fields.read("leds", leds.c_str(),
              [&](const Json& value) { return take_leds(value, most_leds, request.leds); });
  fields.flag("repeat", request.repeat);
  fields.read("bracket", "0.001 to 100", [&](const Json& value) {
    if (!value.is_number() || !(value.get<double>() >= 0.001 && value.get<double>() <= 100)) return false;
    request.bracket = value.get<double>();
    return true;
  });
  const std::string states = rig.polariser.states.empty()
                                 ? "none: the rig file has no [polariser]"
                                 : "different ones of [polariser] states in the rig file";
  fields.read("polariser", states.c_str(), [&](const Json& value) {
    return take_states(value, rig.polariser.states, request.polariser.states);
  });
  fields.read("below", rig.below ? "true or false" : "false: the rig file has no [below]",
              [&](const Json& value) {
                if (!value.is_boolean() || (value.get<bool>() && !rig.below)) return false;
                request.below = value.get<bool>();
                return true;
              });
}

}  // namespace

Result<Json> parse_body(std::string_view body) {
  if (body.find_first_not_of(" \t\r\n") == std::string_view::npos) return Json::object();
  auto [json, why] = parse_json(body);
  if (!why.empty()) return refuse("body", why, "send one JSON object, as in {\"fabric\": \"satin\"}");
  if (!json.is_object())
    return refuse("body", "is no JSON object", "send one, as in {\"fabric\": \"satin\"}");
  return json;
}

Result<std::string> session_in_body(const Json& body) {
  std::string name;
  Fields fields(body);
  fields.text("session", "a name of letters, digits, '.', '_' and '-'", name, library::is_session_name);
  if (fields.error()) return *fields.error();
  return name;
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
  const capture::ScanRequest of_rig = request;
  request.polariser.states.clear();
  request.below = false;
  Fields plan(session.document["plan"]);
  read_plan(plan, rig.leds, of_rig, request);
  return request;
}

Result<ScanWish> read_scan_body(const Json& body, int leds, const capture::ScanRequest& otherwise) {
  if (auto unknown = unknown_field(body)) return std::move(*unknown);
  const Result<std::string> name = session_in_body(body);
  if (!name) return name.error();
  ScanWish wish = {*name, otherwise};
  capture::ScanRequest& request = wish.request;
  bool copy = true;

  Fields fields(body);
  fields.text("fabric", "1 to 200 characters", request.fabric, is_fabric);
  fields.number("cloth_height_mm", "-1000 to 1000", -1000, 1000, request.cloth_height_mm);
  fields.number("tilt_deg", "0 to 45", 0, kMostTilt_deg, request.pose.tilt_deg);
  fields.number("downhill_deg", "-360 to 360", -360, 360, request.pose.downhill_deg);
  fields.number("exposure_us", "0 (metered), or up to 1e9", 0, 1e9, request.exposure.exposure_us);
  fields.number("iso", "1 to 1e6", 1, 1e6, request.exposure.iso);
  fields.number("f_number", "0.5 to 128", 0.5, 128, request.exposure.f_number);
  if (const auto metadata = body.find("metadata"); metadata != body.end() && !metadata->is_null()) {
    if (Result<void> ok = library::check_new_metadata(*metadata); !ok) return std::move(ok).error();
    request.metadata = *metadata;
  }
  read_plan(fields, leds, otherwise, request);
  std::string accept_moved;
  fields.text("accept_moved", "the reason in 1 to 200 characters", accept_moved, is_fabric);
  if (!accept_moved.empty()) request.accepted_moved = {{"why", accept_moved}};
  std::string request_id;  // whoever begins the scan looks at it
  fields.text("request_id", "1 to 200 characters", request_id, is_fabric);
  fields.flag("copy", copy);
  fields.flag("dry_run", wish.dry_run);
  if (fields.error()) return *fields.error();
  if (!copy) request.copy.clear();
  return wish;
}

}  // namespace weft::app
