// SPDX-License-Identifier: Apache-2.0
#include "material/run/maps_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "material/run/session_sets.h"
#include "report/page.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

std::string number_text(double number) {
  return std::isfinite(number) ? fmt::format("{:.4g}", number) : "";
}

report::Table table_of(const std::vector<MapFacts>& maps) {
  report::Table table = {.header = {"map", "least", "mean", "most", "unit", "comes from"}};
  for (const MapFacts& map : maps) {
    if (map.constant) {
      table.rows.push_back({map.name, "", number_text(*map.constant), "", map.unit, map.why});
    } else {
      table.rows.push_back({map.name, number_text(map.least), number_text(map.mean), number_text(map.most),
                            map.unit, name_of(map.source)});
    }
  }
  return table;
}

report::Table table_of_checks(const std::vector<MapCheck>& checks) {
  report::Table table = {.header = {"check", "", "number", "limit"}};
  for (const MapCheck& check : checks) {
    if (check.severity != Severity::kPassed) table.alarms.insert(table.rows.size());
    table.rows.push_back(
        {check.name, name_of(check.severity), number_text(check.number), number_text(check.limit)});
  }
  return table;
}

report::Table table_of_steps(const std::vector<MapStep>& steps) {
  report::Table table = {.header = {"step", "told, and found", ""}};
  for (const MapStep& step : steps) {
    Json told = step.document;
    for (const char* key : {"do", "facts"}) told.erase(key);
    report::add_rows(table, told, {step.name});
    report::add_rows(table, step.facts.is_null() ? Json::object() : step.facts, {step.name});
  }
  return table;
}

Result<std::vector<report::Figure>> pictures_of(const fs::path& folder, const MapSetFacts& facts) {
  std::vector<std::pair<std::string, std::string>> shown;
  for (const MapStep& step : facts.steps) {
    if (step.facts.contains("picture"))
      shown.emplace_back(step.facts["picture"].get<std::string>(), "where the yarns seem to lie");
  }
  for (const auto& [file, label] : {std::pair{"albedo.png", "albedo"},
                                    {"normal.png", "normal"},
                                    {"relit.png", "relit from the upper left"}})
    shown.emplace_back(file, label);
  for (const MapFacts& map : facts.maps) {
    if (!map.picture.empty()) shown.emplace_back(map.picture, map.name);
  }
  for (const MapCheck& check : facts.checks) {
    if (!check.picture.empty()) shown.emplace_back(check.picture, check.name);
  }
  std::vector<report::Figure> pictures;
  for (const auto& [file, label] : shown) {
    Result<std::string> png = read_text(folder / file);
    if (!png) return png.error();
    pictures.push_back({label, report::Png{std::move(*png)}});
  }
  return pictures;
}

}  // namespace

Result<void> write_maps_page(const fs::path& folder, const MapSetFacts& facts) {
  Result<std::vector<report::Figure>> pictures = pictures_of(folder, facts);
  if (!pictures) return pictures.error();
  const double mm = facts.mm_per_pixel;
  report::Page page = {.title = "Maps",
                       .meta = {fmt::format("{} × {} pixels of {:.4g} mm: {:.4g} × {:.4g} mm{}",
                                            facts.size.width, facts.size.height, mm, facts.size.width * mm,
                                            facts.size.height * mm, facts.is_tile ? ", a tile" : "")},
                       .verdicts = facts.verdicts,
                       .sections = {{.figures = std::move(*pictures)},
                                    {.title = "Derived maps", .table = table_of(facts.maps)},
                                    {.title = "Checks", .table = table_of_checks(facts.checks)},
                                    {.title = "Finishing", .table = table_of_steps(facts.steps)}}};
  std::ranges::copy(source_lines(facts.source), std::back_inserter(page.meta));
  if (page.verdicts.empty()) page.summary = "Nothing speaks against them.";
  return write_file(folder / "report.html", html_of(page));
}

}  // namespace weft::material
