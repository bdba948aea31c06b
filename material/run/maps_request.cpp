// SPDX-License-Identifier: Apache-2.0
#include "material/run/maps_request.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/describe/described_fields.h"
#include "core/rig/cloth_kinds.h"

namespace weft::material {
namespace {

std::string help_of_maps() {
  std::string help = "Which to derive, by commas; default all:";
  for (const DerivedMap& map : derived_maps())
    help += fmt::format("{} {}, {}", &map == &derived_maps().front() ? "" : ";", map.name, map.says);
  return help;
}

std::string why_not_steps(const Json& steps) {
  if (steps.is_null()) return "";
  const Result<Recipe> recipe = recipe_from_json(steps, "it");
  return recipe ? "" : fmt::format("{}: {}", recipe.error().where, recipe.error().why);
}

void describe_recipe(Fields& fields, MapsRequest& r) {
  fields.value({"steps", R"(Recipe as JSON: {"steps": [{"do": "tile"}]})"}, r.steps);
  const std::string why = why_not_steps(r.steps);
  fields.require(why.empty(), "steps", why);
  fields.value({.name = "recipe",
                .says = "Recipe: a TOML file, the maps.json of other maps, or flat, tile, detail "
                        "(docs/finishing.md)",
                .path = PathTo::kNamed,
                .words = recipe_names()},
               r.recipe);
  fields.exclude("steps", "recipe");
}

void describe_common(Fields& fields, MapsRequest& r) {
  describe_session(fields, r.maps.session);
  describe_solve(fields, r.maps.solve, r.maps.is_draft, r.maps.calibration);
  describe_output(fields, r.maps.output, "Folder for the maps; default SESSION/maps/ID");
  describe_grid(fields, r.maps.mm_per_pixel);
  describe_recipe(fields, r);
  fields.value({"preview", "Of a large cloth the middle, at its full size; earlier previews go"},
               r.maps.is_preview);
  describe_compression(fields, r.maps.compression);
  fields.value({.name = "strict",
                .says = "Exit code 2 where something speaks against the maps",
                .said = Said::kAtThisMachine},
               r.is_strict);
}

void describe_derived(Fields& fields, DeriveOptions& d) {
  fields.choice({"height", "How slopes are integrated: tiled, direct, multigrid, seed"}, d.height,
                kHeightMethodNames);
  fields.value({.name = "weigh", .says = "Height: each pixel by one over its variance"}, d.weighs_by_sigma);
  fields.value({"cavity_mm", "Radius that a cavity is seen against, mm", {0.01, 1000}}, d.cavity_mm);
  fields.value({"directions", "Of the occlusion's lines, 4 to 64", {4, 64}}, d.directions);
  fields.value({.name = "cloth",
                .says = "Whose lobe is typed where the photographs tell none; default the session's kind",
                .words = {kClothKinds.begin(), kClothKinds.end()}},
               d.cloth);
}

void describe_aims(Fields& fields, MapsRequest& r) {
  fields.value({.name = "explain",
                .says = "Only say what heights and occlusion cost and are off by, on a piece of this cloth",
                .said = Said::kAtThisMachine},
               r.only_explains);
  fields.value(
      {.name = "to", .says = "Rms of openness that is good enough: chooses --directions", .range = {1e-6, 1}},
      r.aims.to);
  fields.value({.name = "within_s",
                .says = "Seconds that occlusion may take: chooses --directions",
                .range = kAboveZero},
               r.aims.within_s);
  fields.exclude("to", "directions");
  fields.exclude("within_s", "directions");
  fields.exclude("within_s", "to");
}

}  // namespace

Result<Recipe> MapsRequest::asked_recipe() const {
  if (!steps.is_null()) return recipe_from_json(steps, "--steps");
  return recipe.empty() ? Recipe() : read_recipe(recipe);
}

void describe(Fields& fields, MapsRequest& r) {
  describe_common(fields, r);
  std::vector<std::string> names;
  for (const DerivedMap& map : derived_maps()) names.emplace_back(map.name);
  fields.value({.name = "maps", .says = help_of_maps(), .words = std::move(names)}, r.maps.maps);
  fields.value({.name = "bare",
                .says = "Session of the table without cloth, photographed by the light below at the same "
                        "exposure",
                .path = PathTo::kSession},
               r.maps.bare);
  fields.value({.name = "table",
                .says = "Albedo R,G,B of the table that shows through holes, to be taken out of their rims",
                .range = {0, 1},
                .fewest = 3,
                .most = 3},
               r.maps.table_albedo);
  fields.need("table", "bare");
  describe_derived(fields, r.maps.derive);
  describe_aims(fields, r);
}

void describe(Fields& fields, FinishRequest& request) {
  describe_common(fields, request);
  fields.value({.name = "explain",
                .says = "Only say what each step takes and what is lost on this grid, and on ones twice and "
                        "four times as coarse",
                .said = Said::kAtThisMachine},
               request.only_explains);
  fields.value({.name = "to_deg",
                .says = "Choose the coarsest of these grids that loses so many degrees",
                .range = kAboveZero},
               request.grid.to_deg);
  fields.value({.name = "within_s",
                .says = "Choose the finest of these grids that takes so many seconds, by --explain",
                .range = kAboveZero},
               request.grid.within_s);
  fields.exclude("within_s", "to_deg");
  for (const char* priced : {"explain", "to_deg", "within_s"}) fields.exclude(priced, "preview");
}

}  // namespace weft::material
