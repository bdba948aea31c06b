// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/describe/field_json.h"
#include "library/chain/make.h"
#include "material/run/finish_price.h"
#include "material/run/maps_price.h"
#include "material/run/maps_request.h"
#include "material/run/session_sets.h"
#include "solve/session/solved.h"

namespace weft::app {
namespace {

void print_words(const material::MapsReport& report) {
  const material::MapSetFacts& facts = report.facts;
  print(report.folder.string());
  if (report.was_there) print("  is there already: same solve, same recipe, same options");
  print(fmt::format("  {} x {} pixels of {:.5g} mm{}", facts.size.width, facts.size.height,
                    facts.mm_per_pixel, facts.is_tile ? ", a tile" : ""));
  for (const std::string& line : material::source_lines(facts.source)) print("  " + line);
  for (const material::MapFacts& map : facts.maps) {
    const std::string unit = map.unit.empty() ? "" : " " + map.unit;
    if (map.constant) {
      print(fmt::format("  {}: {:.4g}{}, {}", map.name, *map.constant, unit, map.why));
    } else {
      print(fmt::format("  {}: {:.4g} to {:.4g}{}, {}", map.name, map.least, map.most, unit,
                        name_of(map.source)));
    }
  }
  for (const Verdict& verdict : facts.verdicts)
    print(fmt::format("  {}: {}; {}", verdict.name, verdict.text, verdict.remedy));
  print(fmt::format("  look at {}", (report.folder / "report.html").string()));
}

void print_prices(const material::MapPrices& prices) {
  print(fmt::format("{:10}  {:14}  {:>8}  {:>9}", "map", "setting", "seconds", "rms error"));
  for (const material::MapPrice& price : prices.rows) {
    print(fmt::format("{:10}  {:14}  {:>8.2f}  {:>9.5f} {}{}", price.map, price.setting, price.seconds,
                      price.error, price.unit,
                      price.is_chosen    ? ", chosen"
                      : price.is_default ? ", default"
                                         : ""));
  }
  print("height: against its first row, which is exact; occlusion: against 64 directions");
}

// What each setting costs and is off by on a piece of this cloth, before any of it is spent.
Result<int> explain(material::MapsRequest& arguments, const CommonArguments& common) {
  const Result<material::MapPrices> prices = [&] {
    ProgressLine line(common.quiet);
    return material::price_maps(arguments.maps, arguments.aims,
                                {common.threads, stop_on_signal(), line.callback()});
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

// Whoever names a solve, or is content with a draft, gets what there is.
Result<void> make_solve_first(material::MapsOptions& options, const JobContext& context,
                              const library::TellStep& tell) {
  if (!options.solve.empty() || options.is_draft) return {};
  Result<std::string> made = library::make_solve_first(options.session, context, tell);
  if (!made) return std::move(made).error();
  options.solve = std::move(*made);
  return {};
}

Result<int> make(const material::MapsRequest& arguments, const CommonArguments& common) {
  Result<material::Recipe> recipe = arguments.asked_recipe();
  if (!recipe) return std::move(recipe).error();
  material::MapsOptions options = arguments.maps;
  options.recipe = std::move(*recipe);
  const Result<material::MapsReport> report = [&]() -> Result<material::MapsReport> {
    ProgressLine line(common.quiet);
    const JobContext context = {common.threads, stop_on_signal(), line.callback()};
    if (Result<void> ok = make_solve_first(options, context, line.teller()); !ok)
      return std::move(ok).error();
    return material::make_maps(options, context);
  }();
  if (!report) return report.error();
  if (common.json) {
    print_product(json_of(report->facts), report->folder, report->was_there);
  } else {
    print_words(*report);
  }
  const bool has_verdicts = !report->facts.verdicts.empty();
  return arguments.is_strict && has_verdicts ? kDoneWithWarnings : kDone;
}

Run add_maps(Options& options) {
  const auto a = std::make_shared<material::MapsRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) -> Result<int> {
    if (Result<void> ok = solve::keep_pixel(a->maps.session, a->maps.mm_per_pixel); !ok)
      return std::move(ok).error();
    if (a->maps.maps.empty())
      for (const material::DerivedMap& map : material::derived_maps()) a->maps.maps.emplace_back(map.name);
    if (a->only_explains || a->aims.to || a->aims.within_s) {
      const Result<int> explained = explain(*a, common);
      if (!explained || a->only_explains) return explained;
    }
    return make(*a, common);
  };
}

void print_grids(const material::FinishPrices& prices) {
  std::string header =
      fmt::format("{:>10}  {:>13}  {:>7}  {:>8}", "mm a pixel", "pixels", "degrees", "seconds");
  for (const material::StepPrice& step : prices.rows.front().steps)
    header += fmt::format("  {:>10}", step.name);
  print(header);
  for (const material::GridPrice& row : prices.rows) {
    std::string line =
        fmt::format("{:>10.4g}  {:>13}  {:>7.3g}  {:>8.3g}", row.mm_per_pixel,
                    fmt::format("{} x {}", row.size.width, row.size.height), row.lost_deg, row.seconds);
    for (const material::StepPrice& step : row.steps) line += fmt::format("  {:>10.3g}", step.seconds);
    print(line + (row.is_chosen ? "  <- chosen" : ""));
  }
  print("degrees: how far normals of the finest grid are from that of the pixel that they lie in");
}

// What the grids cost, before one is made; the wish chooses.
Result<int> price_grids(material::FinishRequest& arguments, const CommonArguments& common) {
  const Result<material::Recipe> recipe = arguments.asked_recipe();
  if (!recipe) return recipe.error();
  arguments.maps.recipe = *recipe;
  const Result<material::FinishPrices> prices = [&]() -> Result<material::FinishPrices> {
    ProgressLine line(common.quiet);
    const JobContext context = {common.threads, stop_on_signal(), line.callback()};
    if (!arguments.only_explains) {
      if (Result<void> ok = make_solve_first(arguments.maps, context, line.teller()); !ok)
        return std::move(ok).error();
    }
    return material::price_finish(arguments.maps, arguments.grid, context);
  }();
  if (!prices) return prices.error();
  const auto chosen = std::ranges::find_if(prices->rows, &material::GridPrice::is_chosen);
  arguments.maps.mm_per_pixel = chosen->mm_per_pixel;
  if (!arguments.only_explains) {
    if (!common.quiet)
      note(fmt::format("chose {:.4g} mm a pixel: {:.3g} s expected", chosen->mm_per_pixel, chosen->seconds));
  } else if (common.json) {
    print_json(object_of(*prices));
  } else {
    print_grids(*prices);
  }
  return kDone;
}

Run add_finish(Options& options) {
  const auto a = std::make_shared<material::FinishRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) -> Result<int> {
    if (Result<void> ok = solve::keep_pixel(a->maps.session, a->maps.mm_per_pixel); !ok)
      return std::move(ok).error();
    if (a->only_explains || a->grid.is_one()) {
      const Result<int> priced = price_grids(*a, common);
      if (!priced || a->only_explains) return priced;
    }
    return make(*a, common);
  };
}

}  // namespace

Verb maps_verb() {
  return {"maps", "Height, occlusion and other maps of a solve, finished by a recipe", add_maps};
}

Verb finish_verb() {
  return {"finish",
          "A recipe alone (flatten, straighten, crop, tile, repair): albedo and normals, nothing derived",
          add_finish};
}

}  // namespace weft::app
