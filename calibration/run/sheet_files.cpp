// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/sheet_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

// A tag is read by the white about it: a quarter of its side on each side is not paper.
constexpr double kQuietShare = 1.5;

constexpr NumberRange kPaper_mm = {1, 10000};

std::array<double, 3> rgb_of(const std::vector<double>& one_or_three) {
  return one_or_three.size() == 1 ? std::array{one_or_three[0], one_or_three[0], one_or_three[0]}
                                  : std::array{one_or_three[0], one_or_three[1], one_or_three[2]};
}

// The place of a tag that an earlier one has, too.
std::optional<std::size_t> twin_among(const std::vector<SheetTag>& tags) {
  for (std::size_t i = 0; i < tags.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (tags[i].dictionary == tags[j].dictionary && tags[i].id == tags[j].id) return i;
    }
  }
  return {};
}

}  // namespace

void describe(Fields& fields, SheetDescription::Tag& t) {
  fields.value({"dictionary", "As OpenCV names it"}, t.dictionary);
  fields.value({"id", "Its number in the dictionary", {0, 1000000}, kMustSay}, t.id);
  fields.value({"side_mm", "With its black border, mm", {0.1, 10000}, kMustSay}, t.side_mm);
  fields.value({.name = "centre_mm",
                .says = "Right of and above the sheet's centre, mm",
                .need = kMustSay,
                .fewest = 2,
                .most = 2},
               t.centre_mm);
}

void describe(Fields& fields, SheetDescription& s) {
  fields.value({"width_mm", "Of the paper, mm", kPaper_mm, kMustSay}, s.width_mm);
  fields.value({"height_mm", "Of the paper, mm", kPaper_mm, kMustSay}, s.height_mm);
  fields.value({"margin_mm", "Of its border that is not read, mm", {0, 10000}}, s.margin_mm);
  fields.require(2 * s.margin_mm < std::min(s.width_mm, s.height_mm), "margin_mm", "must leave paper to use");
  fields.value(
      {.name = "reflectance",
       .says = "Share of the light that it reflects, one number or three; default: nobody measured it",
       .range = {0.01, 1},
       .need = kUnlessEmpty,
       .fewest = 1,
       .most = 3},
      s.reflectance);
  fields.require(s.reflectance.size() != 2, "reflectance", "must be one number or three");
  fields.value({"delta",
                "It reflects 1 - delta (1 - cosine) of Lambert's law; default: nobody measured it",
                {-0.5, 1}},
               s.delta);
  fields.list({.name = "tag", .says = "Each tag in its border"}, s.tags);
  fields.require(!s.tags.empty(), "tag", "must be one [[tag]] at least");
}

Result<TaggedSheet> read_sheet_file(const fs::path& file) {
  const Result<SheetDescription> said = read_file<SheetDescription>(file, kCalibrationPage);
  if (!said) return said.error();
  TaggedSheet out;
  Sheet& sheet = out.sheet;
  sheet.width_mm = said->width_mm;
  sheet.height_mm = said->height_mm;
  sheet.margin_mm = said->margin_mm;
  if (!said->reflectance.empty()) sheet.reflectance_rgb = rgb_of(said->reflectance);
  out.delta = said->delta;
  for (const SheetDescription::Tag& t : said->tags) {
    const SheetTag& tag =
        out.tags.emplace_back(SheetTag{t.dictionary, t.id, t.side_mm, t.centre_mm[0], t.centre_mm[1]});
    sheet.printed.push_back({tag.centre_u_mm, tag.centre_v_mm, kQuietShare * tag.side_mm});
  }
  if (const auto twin = twin_among(out.tags)) {
    return Error{ErrorKind::kBadData, "the description cannot be used",
                 fmt::format("{}: tag {}: id", file.string(), *twin + 1), "another tag has it, too",
                 fmt::format("see {} for the keys of this file", kCalibrationPage)};
  }
  return out;
}

}  // namespace weft::calibration
