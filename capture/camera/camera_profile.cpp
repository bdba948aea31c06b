// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/camera_profile.h"

#include "core/toml/toml_keys.h"

namespace weft::capture {
namespace {

constexpr const char* kPage = "docs/rig.md";
constexpr const char* kBuiltIn = "nikon-d5100";

std::string needed(TomlKeys& keys, const char* key) {
  const std::string text = keys.text_or(key, "");
  if (text.empty()) keys.reject(key, "it is missing or empty");
  return text;
}

Result<void> read_widgets(const toml::table& table, const std::string& where, CameraProfile& profile) {
  TomlKeys keys(table, where + ": [widgets]", kPage);
  keys.know({"shutter", "iso", "f_number", "model", "serial", "battery", "clock"});
  CameraProfile::Widgets& widgets = profile.widgets;
  widgets.shutter = needed(keys, "shutter");
  widgets.iso = needed(keys, "iso");
  widgets.f_number = keys.text_or("f_number", widgets.f_number);
  widgets.model = keys.text_or("model", widgets.model);
  widgets.serial = keys.text_or("serial", widgets.serial);
  widgets.battery = keys.text_or("battery", widgets.battery);
  widgets.clock = keys.text_or("clock", widgets.clock);
  return keys.status();
}

Result<void> read_by_hand(const toml::table& table, const std::string& where, CameraProfile& profile) {
  TomlKeys keys(table, where + ": [[by_hand]]", kPage);
  keys.know({"widget", "values", "says", "remedy"});
  CameraProfile::ByHand by_hand;
  by_hand.widget = needed(keys, "widget");
  by_hand.values = keys.texts_or("values", {});
  if (by_hand.values.empty()) keys.reject("values", "no value is right");
  by_hand.says = needed(keys, "says");
  by_hand.remedy = needed(keys, "remedy");
  profile.by_hand.push_back(std::move(by_hand));
  return keys.status();
}

std::vector<CameraProfile::Setting> read_settings(const toml::table& table, const char* name,
                                                  TomlKeys& keys) {
  std::vector<CameraProfile::Setting> settings;
  for (const auto& [widget, value] : table) {
    if (const auto text = value.value_exact<std::string>()) {
      settings.emplace_back(widget.str(), *text);
    } else {
      keys.reject(std::string(name) + "." + std::string(widget.str()), "it is not a text in quotes");
    }
  }
  return settings;
}

CameraProfile::Trigger read_trigger(TomlKeys& keys) {
  const std::string name = keys.text_or("trigger", "returns_at_once");
  if (name == "blocks") return CameraProfile::Trigger::kBlocks;
  if (name != "returns_at_once") keys.reject("trigger", "it must be \"blocks\" or \"returns_at_once\"");
  return CameraProfile::Trigger::kReturnsAtOnce;
}

Result<CameraProfile> read_profile(const toml::table& table, const std::string& where) {
  CameraProfile profile;
  TomlKeys keys(table, where, kPage);
  keys.know({"model", "usb", "ptpip", "trigger", "readout_s", "least_battery", "widgets", "by_hand", "set",
             "set_where_there"});
  profile.model = needed(keys, "model");
  profile.usb_models = keys.texts_or("usb", {});
  profile.ptpip_model = keys.text_or("ptpip", profile.ptpip_model);
  profile.trigger = read_trigger(keys);
  profile.readout_s = keys.number_or("readout_s", profile.readout_s, 0.1, 120);
  profile.least_battery = keys.number_or("least_battery", profile.least_battery, 0, 1);
  const Result<void> widgets = read_widgets(keys.table("widgets"), where, profile);
  if (!widgets) return widgets.error();
  if (keys.has("by_hand")) {
    for (const toml::table* each : keys.tables("by_hand")) {
      if (Result<void> read = read_by_hand(*each, where, profile); !read) return std::move(read).error();
    }
  }
  profile.set = read_settings(keys.table("set"), "set", keys);
  profile.set_where_there = read_settings(keys.table("set_where_there"), "set_where_there", keys);
  if (Result<void> ok = keys.status(); !ok) return std::move(ok).error();
  return profile;
}

}  // namespace

Result<CameraProfile> read_camera_profile(const std::string& name_or_file) {
  if (name_or_file == kBuiltIn) return read_profile(toml::parse(nikon_d5100_toml()), kBuiltIn);
  if (!name_or_file.ends_with(".toml")) {
    return Error{ErrorKind::kUsage, "there is no camera profile of this name", name_or_file,
                 std::string("built in is ") + kBuiltIn,
                 "name that one, or a file that ends in .toml (docs/rig.md shows one)"};
  }
  const Result<toml::table> table = read_toml(name_or_file);
  if (!table) return table.error();
  return read_profile(*table, name_or_file);
}

}  // namespace weft::capture
