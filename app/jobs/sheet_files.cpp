// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/sheet_files.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/files.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// A tag is read by the white about it: a quarter of its side on each side is not paper.
constexpr double kQuietShare = 1.5;

// Typed access to one table; the first thing that is wrong is remembered.
class Keys {
 public:
  Keys(const toml::table& table, std::string where) : table_(&table), where_(std::move(where)) {}

  void know(std::initializer_list<std::string_view> names) {
    for (const auto& [key, value] : *table_) {
      if (std::find(names.begin(), names.end(), key.str()) == names.end())
        reject(std::string(key.str()), "there is no such key");
    }
  }
  bool has(const char* key) const { return table_->get(key) != nullptr; }
  double number(const char* key, double least, double most) {
    const std::vector<double> all = numbers(key, 1, 1);
    return all.empty() ? least : within(key, all[0], least, most);
  }
  double number_or(const char* key, double otherwise, double least, double most) {
    return has(key) ? number(key, least, most) : otherwise;
  }
  /// A list of `fewest` to `most` finite numbers, or one number alone where `fewest` is 1.
  std::vector<double> numbers(const char* key, std::size_t fewest, std::size_t most) {
    std::vector<double> all;
    const toml::node* node = table_->get(key);
    if (node == nullptr) {
      reject(key, "it is missing");
      return {};
    }
    if (const auto alone = node->value<double>(); alone && fewest == 1) all.push_back(*alone);
    if (const toml::array* list = node->as_array()) {
      for (const toml::node& entry : *list) {
        if (const auto value = entry.value<double>()) all.push_back(*value);
      }
      if (all.size() != list->size()) all.clear();
    }
    const bool finite = std::all_of(all.begin(), all.end(), [](double v) { return std::isfinite(v); });
    if (finite && all.size() >= fewest && all.size() <= most && (fewest == 1 || all.size() == most))
      return all;
    reject(key, most == 1 ? "it must be a number" : fmt::format("it must be {} numbers", most));
    return {};
  }
  double within(const char* key, double value, double least, double most) {
    if (!(value >= least && value <= most)) reject(key, fmt::format("it must be {} to {}", least, most));
    return value;
  }
  std::string text_or(const char* key, std::string otherwise) {
    if (!has(key)) return otherwise;
    const auto value = table_->get(key)->value<std::string>();
    if (!value) reject(key, "it must be a text");
    return value.value_or(otherwise);
  }
  void reject(const std::string& key, std::string why) {
    if (error_) return;
    error_ = Error{ErrorKind::kBadData, "the description cannot be used", fmt::format("{}: {}", where_, key),
                   std::move(why), "see docs/calibration.md for the keys of this file"};
  }
  Result<void> status() const { return error_ ? Result<void>(*error_) : Result<void>(); }

 private:
  const toml::table* table_;
  std::string where_;
  std::optional<Error> error_;
};

Result<toml::table> parsed(const fs::path& file) {
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  try {
    return toml::parse(*text);
  } catch (const toml::parse_error& e) {
    return Error{ErrorKind::kBadData, "the description cannot be used",
                 fmt::format("{}: line {}", file.string(), e.source().begin.line),
                 std::string(e.description()), "correct it there"};
  }
}

// The tables of [[name]], or an error where it is something else.
Result<std::vector<const toml::table*>> tables_of(const toml::table& table, const char* name,
                                                  const fs::path& file) {
  std::vector<const toml::table*> tables;
  const toml::node* node = table.get(name);
  const toml::array* list = node == nullptr ? nullptr : node->as_array();
  if (list != nullptr) {
    for (const toml::node& entry : *list) {
      if (entry.as_table() != nullptr) tables.push_back(entry.as_table());
    }
  }
  if (list != nullptr && tables.size() == list->size() && !tables.empty()) return tables;
  return Error{ErrorKind::kBadData, "the description cannot be used",
               fmt::format("{}: {}", file.string(), name), fmt::format("there is no [[{}]]", name),
               "see docs/calibration.md for the keys of this file"};
}

}  // namespace

Result<TaggedSheet> read_sheet_file(const fs::path& file) {
  const Result<toml::table> table = parsed(file);
  if (!table) return table.error();
  TaggedSheet out;
  calibration::Sheet& sheet = out.sheet;
  Keys keys(*table, file.string());
  keys.know({"width_mm", "height_mm", "margin_mm", "reflectance", "tag"});
  sheet.width_mm = keys.number("width_mm", 1, 10000);
  sheet.height_mm = keys.number("height_mm", 1, 10000);
  sheet.margin_mm = keys.number_or("margin_mm", 5, 0, 10000);
  if (2 * sheet.margin_mm >= std::min(sheet.width_mm, sheet.height_mm))
    keys.reject("margin_mm", "it leaves no paper to use");
  if (keys.has("reflectance")) {
    std::vector<double> values = keys.numbers("reflectance", 1, 3);
    if (values.size() == 2) keys.reject("reflectance", "it must be one number or three");
    for (const double value : values) keys.within("reflectance", value, 0.01, 1);
    if (values.size() == 1) values.resize(3, values[0]);
    if (values.size() == 3) sheet.reflectance_rgb = {values[0], values[1], values[2]};
  }
  if (Result<void> ok = keys.status(); !ok) return std::move(ok).error();
  const auto tags = tables_of(*table, "tag", file);
  if (!tags) return tags.error();
  for (std::size_t i = 0; i < tags->size(); ++i) {
    Keys tag_keys(*(*tags)[i], fmt::format("{}: tag {}", file.string(), i + 1));
    tag_keys.know({"dictionary", "id", "side_mm", "centre_mm"});
    calibration::SheetTag& tag = out.tags.emplace_back();
    tag.dictionary = tag_keys.text_or("dictionary", "DICT_APRILTAG_36h11");
    const double id = tag_keys.number("id", 0, 1e6);
    if (id != std::floor(id)) tag_keys.reject("id", "it must be a whole number");
    tag.side_mm = tag_keys.number("side_mm", 0.1, 10000);
    const std::vector<double> centre = tag_keys.numbers("centre_mm", 2, 2);
    if (Result<void> ok = tag_keys.status(); !ok) return std::move(ok).error();
    tag.id = static_cast<int>(id);
    tag.centre_u_mm = centre[0];
    tag.centre_v_mm = centre[1];
    const auto twin = [&](const calibration::SheetTag& other) {
      return &other != &tag && other.dictionary == tag.dictionary && other.id == tag.id;
    };
    if (std::any_of(out.tags.begin(), out.tags.end(), twin)) {
      tag_keys.reject("id", "another tag has it, too");
      return std::move(tag_keys.status()).error();
    }
    sheet.printed.push_back({tag.centre_u_mm, tag.centre_v_mm, kQuietShare * tag.side_mm});
  }
  return out;
}

Result<NearLights> read_rig_file(const fs::path& file) {
  const Result<toml::table> table = parsed(file);
  if (!table) return table.error();
  Keys keys(*table, file.string());
  keys.know({"led"});
  if (Result<void> ok = keys.status(); !ok) return std::move(ok).error();
  const auto leds = tables_of(*table, "led", file);
  if (!leds) return leds.error();
  NearLights lights;
  for (std::size_t k = 0; k < leds->size(); ++k) {
    Keys led_keys(*(*leds)[k], fmt::format("{}: LED {}", file.string(), k + 1));
    led_keys.know({"position_mm", "aim", "mu"});
    NearLight& led = lights.leds.emplace_back();
    const std::vector<double> at = led_keys.numbers("position_mm", 3, 3);
    const std::vector<double> aim =
        led_keys.has("aim") ? led_keys.numbers("aim", 3, 3) : std::vector<double>();
    led.mu = led_keys.number_or("mu", 1, 0, 100);
    if (!at.empty()) led.position_mm = {at[0], at[1], at[2]};
    if (!at.empty() && !(at[2] >= 1 && length(led.position_mm) < 1e5))
      led_keys.reject("position_mm", "it must be at least 1 mm above the table");
    led.aim = aim.empty() ? -1.0 * led.position_mm : Vec3{aim[0], aim[1], aim[2]};
    if (!(length(led.aim) > 0)) led_keys.reject("aim", "it has no length");
    if (Result<void> ok = led_keys.status(); !ok) return std::move(ok).error();
    led.aim = normalized(led.aim);
  }
  return lights;
}

}  // namespace weft::app
