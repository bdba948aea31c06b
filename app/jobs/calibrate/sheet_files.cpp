// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/calibrate/sheet_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/toml/toml_keys.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// A tag is read by the white about it: a quarter of its side on each side is not paper.
constexpr double kQuietShare = 1.5;

}  // namespace

Result<TaggedSheet> read_sheet_file(const fs::path& file) {
  const Result<toml::table> table = read_toml(file);
  if (!table) return table.error();
  TaggedSheet out;
  calibration::Sheet& sheet = out.sheet;
  TomlKeys keys(*table, file.string(), kCalibrationPage);
  keys.know({"width_mm", "height_mm", "margin_mm", "reflectance", "delta", "tag"});
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
  if (keys.has("delta")) out.delta = keys.number("delta", -0.5, 1);
  const std::vector<const toml::table*> tags = keys.tables("tag");
  if (Result<void> ok = keys.status(); !ok) return std::move(ok).error();
  for (std::size_t i = 0; i < tags.size(); ++i) {
    TomlKeys tag_keys(*tags[i], fmt::format("{}: tag {}", file.string(), i + 1), kCalibrationPage);
    tag_keys.know({"dictionary", "id", "side_mm", "centre_mm"});
    calibration::SheetTag& tag = out.tags.emplace_back();
    tag.dictionary = tag_keys.text_or("dictionary", "DICT_APRILTAG_36h11");
    if (!tag_keys.has("id")) tag_keys.reject("id", "it is missing");
    tag.id = tag_keys.integer_or("id", 0, 0, 1000000);
    tag.side_mm = tag_keys.number("side_mm", 0.1, 10000);
    const std::vector<double> centre = tag_keys.numbers("centre_mm", 2, 2);
    if (Result<void> ok = tag_keys.status(); !ok) return std::move(ok).error();
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

}  // namespace weft::app
