// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/accuracy/bound.h"
#include "bench/accuracy/contenders.h"
#include "bench/accuracy/coverage.h"
#include "bench/accuracy/curves.h"
#include "bench/accuracy/score.h"
#include "core/files.h"

namespace weft::bench {
namespace {

// Mean degrees of a research prototype of the same levels on weaves of the same families, for comparison.
struct Prototype {
  const char* scene;
  const char* standard;
  const char* reference;
};
constexpr std::array<Prototype, 10> kPrototype = {{{"smooth lambert", "0.18", "0.18"},
                                                   {"smooth cotton", "0.36", "0.34"},
                                                   {"smooth satin", "0.53", "0.35"},
                                                   {"plain lambert", "0.95", "0.70"},
                                                   {"plain white", "1.64", "1.32"},
                                                   {"plain satin", "1.11", ""},
                                                   {"deep lambert", "4.1", "2.4"},
                                                   {"deep white", "7.7", "3.6"},
                                                   {"deep cotton", "3.6", "2.1"},
                                                   {"deep velvet", "3.0", ""}}};

using Cells = std::vector<std::string>;

std::string cell_of(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "";
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_number_float()) return value.dump();
  return fmt::format("{:.3g}", value.get<double>());
}

std::string markdown_table(const std::vector<Cells>& rows) {
  std::string table;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    table += fmt::format("| {} |\n", fmt::join(rows[i], " | "));
    if (i > 0) continue;
    table += '|';
    for (std::size_t c = 0; c < rows[i].size(); ++c) table += "---|";
    table += '\n';
  }
  return table + '\n';
}

// The named columns of some rows.
std::string columns_table(const Rows& rows, const std::vector<std::pair<const char*, const char*>>& columns) {
  std::vector<Cells> cells(1);
  for (const auto& [key, heading] : columns) cells[0].emplace_back(heading);
  for (const Json& row : rows) {
    Cells& line = cells.emplace_back();
    for (const auto& [key, heading] : columns) line.push_back(row.contains(key) ? cell_of(row[key]) : "");
  }
  return markdown_table(cells);
}

std::vector<std::string> distinct(const Rows& rows, const char* key) {
  std::vector<std::string> values;
  for (const Json& row : rows) {
    std::string value = cell_of(row[key]);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(std::move(value));
  }
  return values;
}

// A line for each scene and a column for each method.
std::vector<Cells> by_scene_and_method(const Rows& rows, const char* key) {
  const std::vector<std::string> methods = distinct(rows, "method");
  std::vector<Cells> cells = {{"scene"}};
  cells[0].insert(cells[0].end(), methods.begin(), methods.end());
  for (const std::string& scene : distinct(rows, "scene")) {
    Cells& line = cells.emplace_back(Cells{scene});
    for (const Json& row : rows) {
      if (row["scene"] == scene) line.push_back(cell_of(row[key]));
    }
  }
  return cells;
}

void add_prototype(std::vector<Cells>& cells) {
  cells[0].insert(cells[0].end(), {"prototype's standard", "its reference"});
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const auto known = std::find_if(kPrototype.begin(), kPrototype.end(),
                                    [&](const Prototype& p) { return cells[i][0] == p.scene; });
    cells[i].emplace_back(known == kPrototype.end() ? "" : known->standard);
    cells[i].emplace_back(known == kPrototype.end() ? "" : known->reference);
  }
}

// A line for each albedo and tilt: ratio to the bound, and share within chi-square's 68 percent.
std::string bound_table(const Rows& rows) {
  const std::vector<std::string> methods = distinct(rows, "method");
  std::vector<Cells> cells = {{"albedo", "tilt, degrees", "bound, degrees"}};
  cells[0].insert(cells[0].end(), methods.begin(), methods.end());
  for (std::size_t i = 0; i < rows.size(); i += methods.size()) {
    Cells& line = cells.emplace_back(
        Cells{cell_of(rows[i]["albedo"]), cell_of(rows[i]["tilt_deg"]), cell_of(rows[i]["bound_deg"])});
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const Json& row = rows[i + m];
      line.push_back(
          fmt::format("{:.3f}, {:.1f} %", number(row, "ratio_to_bound"), 100 * number(row, "within_68")));
    }
  }
  return markdown_table(cells);
}

// How many rows have a key that is true.
std::int64_t count_true(const Rows& rows, const char* key) {
  return std::ranges::count_if(rows, [&](const Json& row) { return row[key].get<bool>(); });
}

std::string coverage_section(const Rows& rows) {
  std::string section = "## How sure the maps are\n\n";
  section += fmt::format(
      "The angle between solved and true normal over `normal_deg` of sigma.exr, at every pixel with a "
      "solution. "
      "Its median is to lie from {} to {} (0.83 where the error is Gaussian), and under {:.0f} percent are "
      "to be "
      "beyond 3: so it is on {} of the {} lines. The worst tenth is that of the pixels in order of their "
      "sigma "
      "whose median is farthest from 1; on {} lines the median of every tenth is within the same limits. "
      "Pixels "
      "that are SATURATED, SPECULAR or nearly without a choice of readings are left out where they are under "
      "a "
      "fifth.\n\n",
      kLeastMedian, kMostMedian, 100 * kMostBeyond, count_true(rows, "holds"), rows.size(),
      count_true(rows, "each_tenth_holds"));
  return section + columns_table(rows, {{"scene", "scene"},
                                        {"level", "level"},
                                        {"seed", "seed"},
                                        {"median_over_sigma", "median of error over sigma"},
                                        {"beyond_3", "beyond 3 sigma"},
                                        {"worst_tenth", "worst tenth"},
                                        {"worst_tenth_beyond_3", "most beyond 3 in a tenth"},
                                        {"flagged", "flagged"},
                                        {"left_out", "and left out"},
                                        {"holds", "holds"},
                                        {"each_tenth_holds", "in every tenth"}});
}

bool is_yardstick(const Json& row) {
  return row["method"] == "oracle";
}

Rows overall(const Rows& table) {
  Rows rows;
  std::copy_if(table.begin(), table.end(), std::back_inserter(rows),
               [](const Json& row) { return row["scene"] == kAllScenes; });
  return rows;
}

}  // namespace

Result<AccuracyFigures> measure_figures(const AccuracyTableOptions& options) {
  AccuracyTableOptions levels = options;
  levels.methods.clear();
  for (const Contender& contender : contenders()) {
    if (contender.is_quality) levels.methods.push_back(contender.name);
  }
  AccuracyTableOptions all_levels = options;
  all_levels.methods.clear();
  AccuracyTableOptions small = options;
  small.quick = true;
  AccuracyFigures figures;
  const std::array<std::pair<Rows*, Result<Rows>>, 7> parts = {
      {{&figures.table, accuracy_table(options)},
       {&figures.coverage, coverage_table(all_levels)},
       {&figures.leds, accuracy_by_leds(levels)},
       {&figures.curves, accuracy_curves(small)},
       {&figures.gates, accuracy_gates(small)},
       {&figures.bound, accuracy_bound({{}, options.threads})},
       {&figures.specular, specular_warnings(levels)}}};
  for (const auto& [rows, measured] : parts) {
    if (!measured) return measured.error();
    *rows = *measured;
  }
  return figures;
}

report::Plot accuracy_plot(const AccuracyFigures& figures) {
  report::Plot plot = {.title = "Error against time, mean over all scenes",
                       .x_label = "nanoseconds a pixel",
                       .y_label = "mean angular error, degrees",
                       .series = {{"level"}, {"method"}},
                       .frontier = true,
                       .log_x = true,
                       .log_y = true};
  const std::vector<Contender> all = contenders();
  for (const Json& row : overall(figures.table)) {
    if (is_yardstick(row)) continue;
    const std::string name = row["method"];
    const bool is_level = std::any_of(all.begin(), all.end(),
                                      [&](const Contender& c) { return c.is_quality && c.name == name; });
    plot.series[is_level ? 0 : 1].points.push_back(
        {number(row, "ns_per_pixel"), number(row, "mean_deg"), name});
  }
  // A curve ends at the level's own mark, with all LEDs; without one (the oracle) there is no curve.
  const auto ends_at = [&](const std::string& method) {
    for (const report::PlotSeries& series : plot.series) {
      for (const report::PlotPoint& p : series.points) {
        if (p.label == method) return report::PlotPoint{p.x, p.y, ""};
      }
    }
    return report::PlotPoint{};
  };
  for (const std::string& method : distinct(figures.leds, "method")) {
    const report::PlotPoint with_all = ends_at(method);
    if (with_all.x == 0) continue;
    report::PlotSeries curve = {method + " by LEDs", {}, true};
    for (const Json& row : figures.leds) {
      if (row["method"] != method || row["leds"] == figures.leds.back()["leds"]) continue;
      curve.points.push_back({number(row, "ns_per_pixel"), number(row, "mean_deg"), cell_of(row["leds"])});
    }
    curve.points.push_back(with_all);
    plot.series.push_back(std::move(curve));
  }
  return plot;
}

report::Plot curves_plot(const AccuracyFigures& figures) {
  report::Plot plot = {.title = "What each setting buys, mean over all scenes",
                       .x_label = "nanoseconds a pixel",
                       .y_label = "mean angular error, degrees",
                       .log_x = true,
                       .log_y = true};
  for (const std::string& name : distinct(figures.curves, "curve")) {
    report::PlotSeries curve = {name, {}, true};
    for (const Json& row : figures.curves) {
      if (row["curve"] != name) continue;
      curve.points.push_back({number(row, "ns_per_pixel"), number(row, "mean_deg"), row["setting"]});
    }
    plot.series.push_back(std::move(curve));
  }
  return plot;
}

std::string accuracy_markdown(const AccuracyFigures& figures) {
  std::string page = "![mean error against time](pictures/accuracy.svg)\n\n";
  page += fmt::format(
      "All figures of one run on {}, {} threads. The numbers behind plot and tables are in "
      "[accuracy.json](pictures/accuracy.json).\n\n",
      document_of({})["machine"]["processor"].get<std::string>(), figures.table.front()["threads"].dump());
  page += "## All scenes together\n\n";
  page += columns_table(overall(figures.table), {{"method", "method"},
                                                 {"mean_deg", "mean, degrees"},
                                                 {"p95_deg", "95 %"},
                                                 {"ratio_to_bound", "over bound"},
                                                 {"ratio_to_oracle", "over oracle"},
                                                 {"albedo_mean_rel", "albedo error"},
                                                 {"albedo_bias_rel", "bias"},
                                                 {"leak", "leak"},
                                                 {"ns_per_pixel", "ns a pixel"},
                                                 {"ratio_to_unpack", "over unpacking"},
                                                 {"ratio_to_copy", "over a copy"},
                                                 {"pareto", "on the front"}});
  page += "## Mean error by scene, degrees\n\n";
  std::vector<Cells> degrees = by_scene_and_method(figures.table, "mean_deg");
  add_prototype(degrees);
  page += markdown_table(degrees);
  page += "## Mean relative error of albedo by scene\n\n";
  page += markdown_table(by_scene_and_method(figures.table, "albedo_mean_rel"));
  page += "## Leak by scene\n\n";
  page += markdown_table(by_scene_and_method(figures.table, "leak"));
  page += coverage_section(figures.coverage);
  page += "## Fewer LEDs\n\n";
  page += columns_table(figures.leds, {{"leds", "LEDs"},
                                       {"numbers", "which"},
                                       {"method", "method"},
                                       {"mean_deg", "mean, degrees"},
                                       {"p95_deg", "95 %"},
                                       {"albedo_mean_rel", "albedo error"},
                                       {"ns_per_pixel", "ns a pixel"}});
  page +=
      "## Resolution, arithmetic, rays and rounds\n\n![error against time by "
      "setting](pictures/curves.svg)\n\n";
  page += columns_table(figures.curves, {{"curve", "what"},
                                         {"setting", "setting"},
                                         {"mean_deg", "mean, degrees"},
                                         {"p95_deg", "95 %"},
                                         {"albedo_mean_rel", "albedo error"},
                                         {"ns_per_pixel", "ns a pixel"}});
  page += "## What the gates leave out, mean error in degrees\n\n";
  page += markdown_table(by_scene_and_method(figures.gates, "mean_deg"));
  page += "## Photon noise alone, over the bound\n\n";
  page += bound_table(figures.bound);
  page += "## Who says SPECULAR\n\n";
  page += columns_table(figures.specular, {{"method", "method"},
                                           {"cloths", "cloths"},
                                           {"scenes", "scenes"},
                                           {"warned", "over 20 %"},
                                           {"least", "least share"},
                                           {"median", "median"},
                                           {"largest", "largest"}});
  page.pop_back();
  return page;
}

Result<std::string> with_figures(const std::string& page, const std::string& figures) {
  const std::string_view begin = kFiguresBegin, end = kFiguresEnd;
  const std::size_t from = page.find(begin), to = page.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    return Error{ErrorKind::kBadData, "page has no place for figures", "accuracy.md",
                 fmt::format("it lacks the lines \"{}\" and \"{}\"", begin, end), "add them, in this order"};
  }
  return page.substr(0, from + begin.size()) + "\n\n" + figures + "\n" + page.substr(to);
}

Result<void> write_accuracy_docs(const std::filesystem::path& folder, const AccuracyFigures& figures) {
  const std::filesystem::path file = folder / "accuracy.md", pictures = folder / "pictures";
  const Result<std::string> page = read_text(file);
  if (!page) return page.error();
  const Result<std::string> renewed = with_figures(*page, accuracy_markdown(figures));
  if (!renewed) return renewed.error();
  if (Result<void> made = make_writable_folder(pictures); !made) return made;
  const report::Plot plot = accuracy_plot(figures);
  Json document = document_of(figures.table);
  document["coverage"] = figures.coverage;
  document["leds"] = figures.leds;
  document["curves"] = figures.curves;
  document["gates"] = figures.gates;
  document["bound"] = figures.bound;
  document["specular"] = figures.specular;
  document["plot"] = plot_json(plot);
  if (Result<void> ok = write_file(pictures / "accuracy.json", document.dump(1) + "\n"); !ok) return ok;
  if (Result<void> ok = write_file(pictures / "accuracy.svg", plot_svg(plot)); !ok) return ok;
  if (Result<void> ok = write_file(pictures / "curves.svg", plot_svg(curves_plot(figures))); !ok) return ok;
  return write_file(file, *renewed);
}

}  // namespace weft::bench
