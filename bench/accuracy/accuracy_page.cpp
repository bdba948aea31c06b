// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/accuracy/coverage.h"
#include "bench/accuracy/score.h"
#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/base/temporary_folder.h"
#include "core/solve/solve_record.h"

namespace weft::bench {
namespace {

constexpr const char* kListedScene = "testdata/scenes/plain_family.toml";
constexpr const char* kFiguresFile = "accuracy.json";
constexpr const char* kSchema = "weft.accuracy-figures";

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

// A line for each value of one column and a column for each value of another.
std::vector<Cells> crossed(const Rows& rows, const char* line_key, const char* column_key, const char* key) {
  const std::vector<std::string> columns = distinct(rows, column_key);
  std::vector<Cells> cells = {{line_key}};
  cells[0].insert(cells[0].end(), columns.begin(), columns.end());
  for (const std::string& value : distinct(rows, line_key)) {
    Cells& line = cells.emplace_back(Cells{value});
    for (const Json& row : rows) {
      if (row[line_key] == value) line.push_back(cell_of(row[key]));
    }
  }
  return cells;
}

std::vector<Cells> by_scene_and_method(const Rows& rows, const char* key) {
  return crossed(rows, "scene", "method", key);
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
  std::string section = fmt::format(
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

// Cloths that a person tells apart, and the scenes of the set that stand for them.
struct ClothGroup {
  const char* name;
  bool (*has)(const std::string& family, const std::string& material);
};
bool is_matt(const std::string& material) {
  return material == "lambert" || material == "white" || material == "cotton";
}
constexpr std::array<ClothGroup, 6> kGroups = {
    {{"smooth matt cloth", [](const auto& f, const auto& m) { return f == "smooth" && is_matt(m); }},
     {"plain matt weave", [](const auto& f, const auto& m) { return f == "plain" && is_matt(m); }},
     {"deep matt weave", [](const auto& f, const auto& m) { return f == "deep" && is_matt(m); }},
     {"velvet", [](const auto&, const auto& m) { return m == "velvet"; }},
     {"satin", [](const auto&, const auto& m) { return m == "satin"; }},
     {"dark satin", [](const auto&, const auto& m) { return m == "dark-satin"; }}}};

// One level on one group: means over its scenes.
struct LevelOnCloth {
  double seconds = 0;  // of 16 megapixels, from counts in memory to maps
  double mean_deg = 0, albedo_rel = 0;
  double left_out_rel = std::numeric_limits<double>::quiet_NaN();
};

LevelOnCloth measured_on(const Rows& table, const std::string& level, const ClothGroup& group) {
  constexpr double kPixels = 16e6;
  LevelOnCloth sum;
  double n = 0, left_out = 0;
  for (const Json& row : table) {
    const std::string scene = row["scene"];
    const std::size_t blank = scene.find(' ');
    if (row["method"] != level || blank == std::string::npos) continue;
    if (!group.has(scene.substr(0, blank), scene.substr(blank + 1))) continue;
    ++n;
    sum.seconds += number(row, "ns_per_pixel") * 1e-9 * kPixels + row.value("lobe_s", 0.0);
    sum.mean_deg += number(row, "mean_deg");
    sum.albedo_rel += number(row, "albedo_mean_rel");
    left_out += row.contains("left_out_rel") && row["left_out_rel"].is_number() ? number(row, "left_out_rel")
                                                                                : std::nan("");
  }
  return {sum.seconds / n, sum.mean_deg / n, sum.albedo_rel / n, left_out / n};
}

// The table that a person reads who has a scan and no time.
std::string levels_table(const Rows& table) {
  std::vector<Cells> cells = {{"cloth"}};
  for (const std::string& level : level_names()) cells[0].push_back(level);
  for (const ClothGroup& group : kGroups) {
    Cells& line = cells.emplace_back(Cells{group.name});
    for (const std::string& level : level_names()) {
      const LevelOnCloth m = measured_on(table, level, group);
      if (!std::isfinite(m.mean_deg)) {  // not measured
        line.emplace_back();
        continue;
      }
      std::string cell =
          fmt::format("{:.3g} s: **{:.2g}°**, {:.2g} %", m.seconds, m.mean_deg, 100 * m.albedo_rel);
      if (std::isfinite(m.left_out_rel)) cell += fmt::format(", {:.2g} %", 100 * m.left_out_rel);
      line.push_back(std::move(cell));
    }
  }
  return markdown_table(cells);
}

// When a level is not worth its seconds.
std::string advice(const Rows& table) {
  for (const std::string& level : level_names()) {
    if (!std::isfinite(measured_on(table, level, kGroups[0]).mean_deg)) return {};
  }
  const auto deg = [&](const char* level, std::size_t group) {
    return measured_on(table, level, kGroups[group]).mean_deg;
  };
  const auto times = [&](const char* level, const char* of, std::size_t group) {
    return measured_on(table, level, kGroups[group]).seconds / measured_on(table, of, kGroups[group]).seconds;
  };
  constexpr std::size_t kSmooth = 0, kPlain = 1, kDeep = 2, kSatin = 4;
  std::string lines;
  lines += fmt::format(
      "- **preview** is for framing. Do not keep its maps: a quarter of the pixels, and {:.2g}° on a plain "
      "weave where fast has {:.2g}°.\n",
      deg("preview", kPlain), deg("fast", kPlain));
  lines += fmt::format(
      "- **fast** is not for gloss: {:.2g}° on satin where standard has {:.2g}°, for {:.2g} times the "
      "seconds.\n",
      deg("fast", kSatin), deg("standard", kSatin), times("standard", "fast", kSatin));
  lines += fmt::format(
      "- **standard** is the default. Do not stop at it on satin, where robust has {:.2g}° for its {:.2g}°, "
      "or on a deep weave, where reference has {:.2g}° for its {:.2g}°.\n",
      deg("robust", kSatin), deg("standard", kSatin), deg("reference", kDeep), deg("standard", kDeep));
  lines += fmt::format(
      "- **robust** gains nothing on smooth matt cloth ({:.2g}° and {:.2g}°) and on satin takes {:.3g} times "
      "the seconds of standard.\n",
      deg("robust", kSmooth), deg("standard", kSmooth), times("robust", "standard", kSatin));
  lines += fmt::format(
      "- **reference** gains nothing on smooth matt cloth ({:.2g}°); on satin it has {:.2g}° where robust "
      "has "
      "{:.2g}°, and on a plain weave it takes {:.3g} times the seconds of standard.\n\n",
      deg("reference", kSmooth), deg("reference", kSatin), deg("robust", kSatin),
      times("reference", "standard", kPlain));
  return lines;
}

// What `weft solve --explain` says of a plain weave.
Result<std::string> explain_listing(const std::filesystem::path& program) {
  const TemporaryFolder scratch;
  const std::string session = scratch.path() / "plain.weft";
  const auto simulated = run_weft({"simulate", kListedScene, "-o", session, "--quiet"}, program);
  return simulated ? run_weft({"solve", session, "--explain", "--quiet"}, program) : simulated;
}

struct FigurePart {
  const char* name;
  Rows AccuracyFigures::*rows;
  Result<Rows> (*measure)(const AccuracyTableOptions& options);
};

AccuracyTableOptions levels_alone(AccuracyTableOptions options) {
  options.methods = level_names();
  return options;
}
AccuracyTableOptions unnamed(AccuracyTableOptions options) {
  options.methods = {};
  options.scene = "";
  return options;
}
AccuracyTableOptions small(AccuracyTableOptions options) {
  options.quick = true;
  return options;
}

constexpr std::array<FigurePart, 9> kParts = {
    {{"table", &AccuracyFigures::table, [](const auto& o) { return accuracy_table(o); }},
     {"coverage", &AccuracyFigures::coverage, [](const auto& o) { return coverage_table(o); }},
     {"explain", &AccuracyFigures::explain, [](const auto& o) { return explain_table(o); }},
     {"chain", &AccuracyFigures::chain, [](const auto& o) { return chain_table(unnamed(o)); }},
     {"leds", &AccuracyFigures::leds, [](const auto& o) { return accuracy_by_leds(levels_alone(o)); }},
     {"curves", &AccuracyFigures::curves, [](const auto& o) { return accuracy_curves(small(o)); }},
     {"gates", &AccuracyFigures::gates, [](const auto& o) { return accuracy_gates(small(o)); }},
     {"bound", &AccuracyFigures::bound, [](const auto& o) { return accuracy_bound(unnamed(o)); }},
     {"specular", &AccuracyFigures::specular,
      [](const auto& o) { return specular_warnings(levels_alone(o)); }}}};

}  // namespace

const std::vector<std::string>& figure_parts() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const FigurePart& part : kParts) all.emplace_back(part.name);
    all.emplace_back("listing");
    return all;
  }();
  return names;
}

Result<void> measure_figures(const FiguresOptions& options, AccuracyFigures& figures) {
  const std::vector<std::string>& parts = options.parts.empty() ? figure_parts() : options.parts;
  for (const std::string& part : parts) {
    if (std::count(figure_parts().begin(), figure_parts().end(), part) == 0)
      return no_such("part", part, figure_parts());
  }
  const std::string here = fmt::format("solver version {} on {}, {} threads{}", kSolverVersion,
                                       document_of({})["machine"]["processor"].get<std::string>(),
                                       resolved_threads(options.table.threads),
                                       options.table.quick ? ", one small patch a scene" : "");
  for (const std::string& name : parts) {
    figures.measured_by[name] = here;
    if (name == "listing") {
      Result<std::string> listing = explain_listing(options.program);
      if (!listing) return std::move(listing).error();
      figures.listing = std::move(*listing);
      continue;
    }
    const FigurePart& part = *std::find_if(kParts.begin(), kParts.end(),
                                           [&](const FigurePart& each) { return each.name == name; });
    Result<Rows> rows = part.measure(options.table);
    if (!rows) return std::move(rows).error();
    figures.*part.rows = std::move(*rows);
  }
  return {};
}

Json json_of(const AccuracyFigures& figures) {
  Json document = {{"schema", fmt::format("{}/1", kSchema)},
                   {"measured_by", figures.measured_by},
                   {"listing", figures.listing}};
  for (const FigurePart& part : kParts) document[part.name] = figures.*part.rows;
  return document;
}

Result<AccuracyFigures> figures_from_json(const Json& document, const std::string& where) {
  AccuracyFigures figures;
  try {
    figures.measured_by = document.at("measured_by").get<std::map<std::string, std::string>>();
    figures.listing = document.at("listing");
    for (const FigurePart& part : kParts) figures.*part.rows = document.at(part.name).get<Rows>();
  } catch (const Json::exception& e) {
    return Error{ErrorKind::kBadData, "figures cannot be read", where, e.what(),
                 "remove the file and measure all parts again"};
  }
  return figures;
}

report::Plot levels_plot(const AccuracyFigures& figures) {
  report::Plot plot = {.title = "What a level costs and gains",
                       .x_label = "seconds for 16 megapixels",
                       .y_label = "mean error, degrees",
                       .log_x = true,
                       .log_y = true,
                       .large = true};
  for (const std::size_t group : {std::size_t{1}, std::size_t{2}, std::size_t{4}}) {
    report::PlotSeries series = {kGroups[group].name, {}, true};
    for (const std::string& level : level_names()) {
      const LevelOnCloth m = measured_on(figures.table, level, kGroups[group]);
      series.points.push_back({m.seconds, m.mean_deg, group == 2 ? level : ""});
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

std::string summary_markdown(const AccuracyFigures& figures) {
  std::string text = fmt::format(
      "Seconds for a scan of 16 megapixels and ten LEDs ({}); then the mean error of the "
      "normals, of the albedo, and of the light left out when it is predicted from the others, which needs "
      "no truth. Reading the frames and writing the maps comes on top and is the same for all levels.\n\n",
      figures.measured_by.contains("table") ? figures.measured_by.at("table") : "not measured");
  text += levels_table(figures.table);
  text += "![error against seconds, by level](pictures/levels.svg)\n\n";
  text += advice(figures.table);
  text += fmt::format("What `weft solve NAME.weft --explain` prints for {}, before anything is paid:\n\n",
                      kListedScene);
  text += "```\n" + figures.listing + "```\n";
  return text;
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
  std::string page =
      "The numbers behind plots and tables are in [accuracy.json](../pictures/accuracy.json).\n\n"
      "![mean error against time](../pictures/accuracy.svg)\n\n";
  const auto add = [&](const char* heading, const char* part, const std::string& table) {
    if (!figures.measured_by.contains(part)) return;
    page += fmt::format("## {}\n\nBy {}.\n\n{}", heading, figures.measured_by.at(part), table);
  };
  add("All scenes together", "table",
      columns_table(overall(figures.table), {{"method", "method"},
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
                                             {"pareto", "on the front"}}));
  add("Mean error by scene, degrees", "table",
      markdown_table(by_scene_and_method(figures.table, "mean_deg")));
  add("Mean relative error of albedo by scene", "table",
      markdown_table(by_scene_and_method(figures.table, "albedo_mean_rel")));
  add("Leak by scene", "table", markdown_table(by_scene_and_method(figures.table, "leak")));
  add("How sure the maps are", "coverage", coverage_section(figures.coverage));
  add("From captures to maps", "chain",
      columns_table(figures.chain, {{"case", "case"},
                                    {"level", "level"},
                                    {"mean_deg", "mean, degrees"},
                                    {"p95_deg", "95 %"},
                                    {"exact_deg", "mean with exact calibration"},
                                    {"albedo_rel", "albedo error"}}));
  add("What `--explain` foretells, over what comes true", "explain",
      markdown_table(crossed(figures.explain, "scene", "quality", "ratio")));
  add("Fewer LEDs", "leds",
      columns_table(figures.leds, {{"leds", "LEDs"},
                                   {"numbers", "which"},
                                   {"method", "method"},
                                   {"mean_deg", "mean, degrees"},
                                   {"p95_deg", "95 %"},
                                   {"albedo_mean_rel", "albedo error"},
                                   {"ns_per_pixel", "ns a pixel"}}));
  add("Resolution, arithmetic, directions and rounds", "curves",
      "![error against time by setting](../pictures/curves.svg)\n\n" +
          columns_table(figures.curves, {{"curve", "what"},
                                         {"setting", "setting"},
                                         {"mean_deg", "mean, degrees"},
                                         {"p95_deg", "95 %"},
                                         {"albedo_mean_rel", "albedo error"},
                                         {"ns_per_pixel", "ns a pixel"}}));
  add("What stages are left out, mean error in degrees", "gates",
      markdown_table(by_scene_and_method(figures.gates, "mean_deg")));
  if (!figures.bound.empty()) add("Photon noise alone, over the bound", "bound", bound_table(figures.bound));
  add("Who says SPECULAR", "specular",
      columns_table(figures.specular, {{"method", "method"},
                                       {"cloths", "cloths"},
                                       {"scenes", "scenes"},
                                       {"warned", "over 20 %"},
                                       {"least", "least share"},
                                       {"median", "median"},
                                       {"largest", "largest"}}));
  page.pop_back();
  return page;
}

namespace {

Result<std::string> with_part(const std::string& page, const char* name, std::string_view begin,
                              std::string_view end, const std::string& part) {
  const std::size_t from = page.find(begin), to = page.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    return Error{ErrorKind::kBadData, "page has no place for figures", name,
                 fmt::format("it lacks the lines \"{}\" and \"{}\"", begin, end), "add them, in this order"};
  }
  return page.substr(0, from + begin.size()) + "\n\n" + part + "\n" + page.substr(to);
}

}  // namespace

Result<std::string> with_summary(const std::string& page, const AccuracyFigures& figures) {
  return with_part(page, kSummaryPage, kSummaryBegin, kSummaryEnd, summary_markdown(figures));
}

Result<std::string> with_figures(const std::string& page, const AccuracyFigures& figures) {
  return with_part(page, kFiguresPage, kFiguresBegin, kFiguresEnd, accuracy_markdown(figures));
}

Result<void> write_accuracy_docs(const std::filesystem::path& folder, const AccuracyFigures& figures) {
  const std::filesystem::path pictures = folder / "pictures";
  const Result<std::string> manual = read_text(folder / kSummaryPage);
  if (!manual) return manual.error();
  const Result<std::string> measured = read_text(folder / kFiguresPage);
  if (!measured) return measured.error();
  const Result<std::string> summary = with_summary(*manual, figures);
  if (!summary) return summary.error();
  const Result<std::string> tables = with_figures(*measured, figures);
  if (!tables) return tables.error();
  if (Result<void> made = make_writable_folder(pictures); !made) return made;
  const std::pair<const char*, report::Plot> kPlots[] = {{"levels.svg", levels_plot(figures)},
                                                         {"accuracy.svg", accuracy_plot(figures)},
                                                         {"curves.svg", curves_plot(figures)}};
  for (const auto& [name, plot] : kPlots) {
    if (Result<void> ok = write_file(pictures / name, plot_svg(plot)); !ok) return ok;
  }
  if (Result<void> ok = write_file(pictures / kFiguresFile, json_of(figures).dump(1) + "\n"); !ok) return ok;
  if (Result<void> ok = write_file(folder / kSummaryPage, *summary); !ok) return ok;
  return write_file(folder / kFiguresPage, *tables);
}

Result<AccuracyFigures> read_accuracy_docs(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "pictures" / kFiguresFile;
  if (!is_there(file)) return AccuracyFigures();
  Result<Json> document = read_json(file, kSchema, 1);
  if (!document) return std::move(document).error();
  return figures_from_json(*document, file.string());
}

}  // namespace weft::bench
