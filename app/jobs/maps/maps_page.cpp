// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/maps/maps_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "app/jobs/maps/session_sets.h"
#include "core/field_json.h"
#include "core/files.h"
#include "core/verdict.h"
#include "report/page.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

std::string number_text(const Json& map, const char* key) {
  return map.contains(key) ? fmt::format("{:.4g}", map[key].get<double>()) : "";
}

report::Table table_of(const Json& maps) {
  report::Table table = {.header = {"map", "least", "mean", "most", "unit", "comes from"}};
  for (const Json& map : maps) {
    const bool is_one = map.contains("constant");
    table.rows.push_back({map["name"].get<std::string>(), number_text(map, "least"),
                          number_text(map, is_one ? "constant" : "mean"), number_text(map, "most"),
                          map.value("unit", ""),
                          is_one ? map["why"].get<std::string>() : map["source"].get<std::string>()});
  }
  return table;
}

report::Table table_of_checks(const Json& checks) {
  report::Table table = {.header = {"check", "", "number", "limit"}};
  for (const Json& check : checks) {
    const std::string severity = check["severity"].get<std::string>();
    if (severity != "passed") table.alarms.insert(table.rows.size());
    table.rows.push_back({check["name"].get<std::string>(), severity, number_text(check, "number"),
                          number_text(check, "limit")});
  }
  return table;
}

report::Table table_of_steps(const Json& steps) {
  report::Table table = {.header = {"step", "told, and found", ""}};
  for (Json step : steps) {
    const std::string name = step["do"].get<std::string>();
    const Json facts = step.value("facts", Json::object());
    for (const char* key : {"do", "facts"}) step.erase(key);
    report::add_rows(table, step, {name});
    report::add_rows(table, facts, {name});
  }
  return table;
}

Result<std::vector<report::Figure>> pictures_of(const fs::path& folder, const Json& document) {
  std::vector<std::pair<std::string, std::string>> shown;
  for (const Json& step : document["steps"]) {
    if (step.contains("facts") && step["facts"].contains("picture"))
      shown.emplace_back(step["facts"]["picture"].get<std::string>(), "where the yarns seem to lie");
  }
  for (const auto& [file, label] : {std::pair{"albedo.png", "albedo"},
                                    {"normal.png", "normal"},
                                    {"relit.png", "relit from the upper left"}})
    shown.emplace_back(file, label);
  for (const Json& map : document["maps"]) {
    if (map.contains("picture"))
      shown.emplace_back(map["picture"].get<std::string>(), map["name"].get<std::string>());
  }
  for (const Json& check : document["checks"]) {
    if (check.contains("picture"))
      shown.emplace_back(check["picture"].get<std::string>(), check["name"].get<std::string>());
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

Result<void> write_maps_page(const fs::path& folder, const Json& document) {
  Result<std::vector<Verdict>> verdicts = read_list<Verdict>(document["verdicts"], "maps.json");
  if (!verdicts) return verdicts.error();
  Result<std::vector<report::Figure>> pictures = pictures_of(folder, document);
  if (!pictures) return pictures.error();
  const int width = document["width"].get<int>(), height = document["height"].get<int>();
  const double mm = document["mm_per_pixel"].get<double>();
  report::Page page = {
      .title = "Maps",
      .meta = {fmt::format("{} × {} pixels of {:.4g} mm: {:.4g} × {:.4g} mm{}", width, height, mm, width * mm,
                           height * mm, document["is_tile"].get<bool>() ? ", a tile" : "")},
      .verdicts = std::move(*verdicts),
      .sections = {{.figures = std::move(*pictures)},
                   {.title = "Derived maps", .table = table_of(document["maps"])},
                   {.title = "Checks", .table = table_of_checks(document["checks"])},
                   {.title = "Finishing", .table = table_of_steps(document["steps"])}}};
  std::ranges::copy(source_lines(document), std::back_inserter(page.meta));
  if (page.verdicts.empty()) page.summary = "Nothing speaks against them.";
  return write_file(folder / "report.html", html_of(page));
}

}  // namespace weft::app
