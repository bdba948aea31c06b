// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/maps/maps.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "app/jobs/maps/price.h"
#include "app/jobs/maps/session_sets.h"
#include "app/jobs/planned_cloth.h"

namespace weft::app {
namespace {

struct MapsArguments {
  MapsOptions maps;
  std::filesystem::path recipe;
  std::string steps;
  bool is_strict = false;
  bool only_explains = false;
  PriceAims aims;
};

std::vector<std::string> map_names() {
  std::vector<std::string> names;
  for (const DerivedMap& map : derived_maps()) names.emplace_back(map.name);
  return names;
}

std::vector<std::string> cloth_names() {
  std::vector<std::string> names;
  for (const NamedCloth& each : planned_cloths()) names.push_back(each.name);
  return names;
}

std::string help_of_maps() {
  std::string help = "Which to derive, by commas; default all:";
  for (const DerivedMap& map : derived_maps())
    help += fmt::format("{} {}, {}", &map == &derived_maps().front() ? "" : ";", map.name, map.says);
  return help;
}

Result<Recipe> asked_recipe(const MapsArguments& a) {
  if (!a.recipe.empty()) return read_recipe(a.recipe);
  if (a.steps.empty()) return Recipe();
  const Json document = Json::parse(a.steps, nullptr, false);
  if (document.is_discarded()) {
    return Error{ErrorKind::kUsage, "the recipe cannot be used", "--steps", "it is no JSON",
                 R"(give {"steps": [{"do": "tile"}]})"};
  }
  return recipe_from_json(document, "--steps");
}

void print_words(const MapsReport& report) {
  const Json& d = report.document;
  print(report.folder.string());
  if (report.was_there) print("  is there already: same solve, same recipe, same options");
  const double mm = d["mm_per_pixel"].get<double>();
  print(fmt::format("  {} x {} pixels of {:.5g} mm{}", d["width"].get<int>(), d["height"].get<int>(), mm,
                    d["is_tile"].get<bool>() ? ", a tile" : ""));
  for (const std::string& line : source_lines(d)) print("  " + line);
  for (const Json& map : d["maps"]) {
    const std::string unit = map.contains("unit") ? " " + map["unit"].get<std::string>() : "";
    if (map.contains("constant")) {
      print(fmt::format("  {}: {:.4g}{}, {}", map["name"].get<std::string>(), map["constant"].get<double>(),
                        unit, map["why"].get<std::string>()));
    } else {
      print(fmt::format("  {}: {:.4g} to {:.4g}{}, {}", map["name"].get<std::string>(),
                        map["least"].get<double>(), map["most"].get<double>(), unit,
                        map["source"].get<std::string>()));
    }
  }
  for (const Json& verdict : d["verdicts"]) {
    print(fmt::format("  {}: {}; {}", verdict["name"].get<std::string>(), verdict["text"].get<std::string>(),
                      verdict["remedy"].get<std::string>()));
  }
  print(fmt::format("  look at {}", (report.folder / "report.html").string()));
}

void print_prices(const MapPrices& prices) {
  print(fmt::format("{:10}  {:14}  {:>8}  {:>9}", "map", "setting", "seconds", "rms error"));
  for (const MapPrice& price : prices.rows) {
    print(fmt::format("{:10}  {:14}  {:>8.2f}  {:>9.5f} {}{}", price.map, price.setting, price.seconds,
                      price.error, price.unit,
                      price.is_chosen    ? ", chosen"
                      : price.is_default ? ", default"
                                         : ""));
  }
  print("height: against the direct solution; occlusion: against 64 directions");
}

// What each setting costs and is off by on a piece of this cloth, before any of it is spent.
Result<int> explain(MapsArguments& arguments, const CommonArguments& common) {
  const Result<MapPrices> prices = [&] {
    ProgressLine line(common.quiet);
    return price_maps(arguments.maps, arguments.aims, {common.threads, stop_on_signal(), line.callback()});
  }();
  if (!prices) return prices.error();
  arguments.maps.derive.directions = prices->directions;
  if (!arguments.only_explains) return kDone;
  if (common.json) {
    print_json({{"rows", json_of(*prices)}});
  } else {
    print_prices(*prices);
  }
  return kDone;
}

Result<int> make(const MapsArguments& arguments, const CommonArguments& common) {
  Result<Recipe> recipe = asked_recipe(arguments);
  if (!recipe) return std::move(recipe).error();
  MapsOptions options = arguments.maps;
  options.recipe = std::move(*recipe);
  const Result<MapsReport> report = [&] {
    ProgressLine line(common.quiet);
    return make_maps(options, {common.threads, stop_on_signal(), line.callback()});
  }();
  if (!report) return report.error();
  if (common.json) {
    print_product(report->document, report->folder, report->was_there);
  } else {
    print_words(*report);
  }
  const bool has_verdicts = !report->document["verdicts"].empty();
  return arguments.is_strict && has_verdicts ? kDoneWithWarnings : kDone;
}

void add_common(Options& options, MapsArguments& a) {
  options.add("session", &a.maps.session, "Session folder, NAME.weft").required();
  options.add("--solve", &a.maps.solve, "Id of the solve; default the session's current one");
  options.add_flag("--draft", &a.maps.is_draft, "A preview will do, of half the size and without masks");
  options.add("--calibration", &a.maps.calibration, "Calibration folder; default the session's own");
  options.add("-o,--output", &a.maps.output, "Folder for the maps; default SESSION/maps/ID");
  options.add("--mm-per-pixel", &a.maps.mm_per_pixel, "Of the grid; default what the camera sees")
      .above_zero();
  const Option steps = options.add("--steps", &a.steps, R"(Recipe as JSON: {"steps": [{"do": "tile"}]})");
  options
      .add("--recipe", &a.recipe,
           "Recipe: a TOML file, the maps.json of other maps, or flat, tile, detail (docs/finishing.md)")
      .excludes(steps);
  options.add_flag("--preview", &a.maps.is_preview, "On a grid four times as coarse; earlier previews go");
  options.add_choice("--compress", &a.maps.compression, kCompressionNames, "Of EXR files: none, zip, piz");
  options.add_flag("--strict", &a.is_strict, "Exit code 2 where something speaks against the maps");
}

Run add_maps(Options& options) {
  const auto a = std::make_shared<MapsArguments>();
  add_common(options, *a);
  DeriveOptions& derive = a->maps.derive;
  options.add("--maps", &a->maps.maps, help_of_maps()).by_commas().one_of(map_names());
  options.add("--bare", &a->maps.bare,
              "Session of the table without cloth, photographed by the light below at the same exposure");
  options
      .add("--table", &a->maps.table_albedo,
           "Albedo R,G,B of the table that shows through holes, to be taken out of their rims")
      .by_commas()
      .takes(3, 3)
      .in_range(0.0, 1.0);
  options.add_choice("--height", &derive.height, kHeightMethodNames,
                     "How slopes are integrated: tiled, direct, multigrid, seed");
  options.add_flag("--weigh", &derive.weighs_by_sigma, "Height: each pixel by one over its variance");
  options.add("--cavity", &derive.cavity_mm, "Radius that a cavity is seen against, mm")
      .in_range(0.01, 1000.0)
      .shows_default();
  const Option directions =
      options.add("--directions", &derive.directions, "Of the occlusion's lines, 4 to 64")
          .in_range(4, 64)
          .shows_default();
  options.add("--cloth", &derive.cloth, "Whose lobe is typed where the photographs tell none")
      .one_of(cloth_names())
      .shows_default();
  options.add_flag("--explain", &a->only_explains,
                   "Only say what heights and occlusion cost and are off by, on a piece of this cloth");
  const Option to =
      options.add("--to", &a->aims.to, "Rms of openness that is good enough: chooses --directions")
          .in_range(1e-6, 1.0)
          .excludes(directions);
  options.add("--within", &a->aims.within_s, "Seconds that occlusion may take: chooses --directions")
      .above_zero()
      .excludes(directions)
      .excludes(to);
  return [a](const CommonArguments& common) {
    if (a->maps.maps.empty()) a->maps.maps = map_names();
    if (a->only_explains || a->aims.to || a->aims.within_s) {
      const Result<int> explained = explain(*a, common);
      if (!explained || a->only_explains) return explained;
    }
    return make(*a, common);
  };
}

Run add_finish(Options& options) {
  const auto a = std::make_shared<MapsArguments>();
  a->recipe = "tile";
  add_common(options, *a);
  return [a](const CommonArguments& common) {
    if (!a->steps.empty()) a->recipe.clear();
    return make(*a, common);
  };
}

}  // namespace

Verb maps_verb() {
  return {"maps", "Derive height, occlusion and other maps from a solve, finished by a recipe", add_maps};
}

Verb finish_verb() {
  return {"finish", "Flatten, straighten, crop, tile and repair the maps of a solve", add_finish};
}

}  // namespace weft::app
