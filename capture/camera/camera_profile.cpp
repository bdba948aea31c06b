// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/camera_profile.h"

#include <array>

#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"

namespace weft::capture {
namespace {

constexpr const char* kPage = "docs/rig.md";
constexpr const char* kBuiltIn = "nikon-d5100";

void describe_needed(Fields& fields, const char* name, const char* says, std::string& text) {
  fields.value({.name = name, .says = says, .need = kMustSay}, text);
  fields.require(!text.empty(), name, "must not be empty");
}

/// A table with a key a widget.
void describe_settings(Fields& fields, const Field& field, std::vector<CameraProfile::Setting>& settings) {
  Json table = Json::object();
  for (const auto& [widget, value] : settings) table[widget] = value;
  fields.value(field, table);
  fields.require(table.is_object(), field.name, "must be a table");
  settings.clear();
  for (const auto& [widget, value] : table.items()) {
    fields.require(value.is_string(), (std::string(field.name) + "." + widget).c_str(),
                   "must be a text in quotes");
    if (value.is_string()) settings.emplace_back(widget, value.get<std::string>());
  }
}

}  // namespace

void describe(Fields& fields, CameraProfile::Widgets& w) {
  describe_needed(fields, "shutter", "That takes the exposure", w.shutter);
  describe_needed(fields, "iso", "That takes the sensitivity", w.iso);
  fields.value({"f_number", "That takes the aperture; empty: a ring on the lens"}, w.f_number);
  fields.value({"model", "That says the body's name"}, w.model);
  fields.value({"serial", "That says the body's number"}, w.serial);
  fields.value({"battery", "That says the charge; empty: it runs on mains"}, w.battery);
  fields.value({"clock", "That says the time; empty: no photograph's own time is used"}, w.clock);
}

void describe(Fields& fields, CameraProfile::ByHand& b) {
  describe_needed(fields, "widget", "That says how it is set", b.widget);
  fields.value({.name = "values", .says = "That are right", .need = kMustSay}, b.values);
  fields.require(!b.values.empty(), "values", "must name one that is right");
  describe_needed(fields, "says", "What is wrong with others", b.says);
  describe_needed(fields, "remedy", "What a person does at the body", b.remedy);
}

void describe(Fields& fields, CameraProfile& p) {
  describe_needed(fields, "model", "As the camera names itself", p.model);
  fields.value({"usb", "As libgphoto2 names it on USB"}, p.usb_models);
  fields.value({"ptpip", "As libgphoto2 names it on a network"}, p.ptpip_model);
  constexpr std::array<const char*, 2> kTriggers = {"blocks", "returns_at_once"};
  fields.choice({"trigger", "When libgphoto2's trigger returns"}, p.trigger, kTriggers);
  fields.value({"readout_s", "Most from the end of an exposure until it has arrived, s", {0.1, 120}},
               p.readout_s);
  fields.value(
      {"shutter_travel_s", "From the exposure of the first row to that of the last, s; 0: unknown", {0, 1}},
      p.shutter_travel_s);
  fields.value({"least_battery", "Share below which no scan begins", {0, 1}}, p.least_battery);
  fields.object({.name = "widgets", .says = "Names of libgphoto2's widgets", .need = kMustSay}, p.widgets);
  fields.list({"by_hand", "What only a person can set at the body"}, p.by_hand);
  describe_settings(fields, {"set", "Widgets with the values that each must take"}, p.set);
  describe_settings(fields, {"set_where_there", "Likewise, for bodies that have them"}, p.set_where_there);
}

Result<CameraProfile> read_camera_profile(const std::string& name_or_file) {
  if (name_or_file == kBuiltIn) {
    return read_fields<CameraProfile>(toml::parse(nikon_d5100_toml()), kBuiltIn, kPage);
  }
  if (!name_or_file.ends_with(".toml")) {
    return Error{ErrorKind::kUsage, "there is no camera profile of this name", name_or_file,
                 std::string("built in is ") + kBuiltIn,
                 "name that one, or a file that ends in .toml (docs/rig.md shows one)"};
  }
  return read_file<CameraProfile>(name_or_file, kPage);
}

}  // namespace weft::capture
