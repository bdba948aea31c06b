// SPDX-License-Identifier: Apache-2.0
#include "material/run/recipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/files.h"
#include "core/base/text.h"
#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUnusable = "the recipe cannot be used";
constexpr const char* kRemedy = "correct it there; docs/finishing.md has every step and key";
constexpr std::size_t kMostSteps = 100, kMostSpots = 1000;

Error unfit(const std::string& where, std::string why) {
  return {ErrorKind::kBadData, kUnusable, where, std::move(why), kRemedy};
}

// A recipe that weft brings along.
struct KnownRecipe {
  const char* name;
  std::vector<const char*> steps;
};

const std::vector<KnownRecipe>& known_recipes() {
  static const std::vector<KnownRecipe> recipes = {{"flat", {"flatten"}},
                                                   {"tile", {"flatten", "straighten", "tile"}},
                                                   {"detail", {"flatten", "straighten", "tile", "detail"}}};
  return recipes;
}

template <typename Named>
std::string nearest_of(const std::string& name, const std::vector<Named>& known) {
  const auto distance = [&](const Named& each) { return edit_distance(name, each.name); };
  return std::ranges::min_element(known, {}, distance)->name;
}

bool is_within(const Json& value, const StepKey& key) {
  return value.is_number() && value.get<double>() >= key.least && value.get<double>() <= key.most;
}

std::string range_of(const StepKey& key) {
  return fmt::format("from {:g} to {:g}", key.least, key.most);
}

bool is_spot(const Json& spot) {
  const std::array<const char*, 3> names = {"x_mm", "y_mm", "radius_mm"};
  return spot.is_object() && spot.size() == names.size() && std::ranges::all_of(names, [&](const char* name) {
           return spot.contains(name) && spot[name].is_number() && std::isfinite(spot[name].get<double>());
         });
}

// What is wrong with the value of a key, if anything is.
std::optional<std::string> fault_of(const Json& value, const StepKey& key) {
  switch (key.holds) {
    case StepHolds::kNumber:
      if (is_within(value, key)) return {};
      return "must be a number " + range_of(key);
    case StepHolds::kMaybe:
      if (value.is_null() || is_within(value, key)) return {};
      return fmt::format("must be a number {}, or be left out", range_of(key));
    case StepHolds::kWhole:
      if (is_within(value, key) && std::floor(value.get<double>()) == value.get<double>()) return {};
      return "must be a whole number " + range_of(key);
    case StepHolds::kFlag:
      if (value.is_boolean()) return {};
      return "must be true or false";
    case StepHolds::kWord:
      if (value.is_string() && std::ranges::find(key.words, value.get<std::string>()) != key.words.end())
        return {};
      return fmt::format("must be one of {}", fmt::join(key.words, ", "));
    case StepHolds::kNumbers: {
      const bool fits = value.is_array() && value.size() == key.otherwise.size() &&
                        std::ranges::all_of(value, [&](const Json& each) { return is_within(each, key); });
      if (fits) return {};
      return fmt::format("must be {} numbers {}", key.otherwise.size(), range_of(key));
    }
    case StepHolds::kSpots:
      if (value.is_array() && value.size() <= kMostSpots && std::ranges::all_of(value, is_spot)) return {};
      return fmt::format("must be a list of up to {} of x_mm, y_mm, radius_mm", kMostSpots);
  }
  return {};
}

// Numbers as JSON has them however they were written: 3 and 3.0 are one recipe.
Json plain(const Json& value, StepHolds holds) {
  if (holds == StepHolds::kWhole) return static_cast<int>(value.get<double>());
  if (holds == StepHolds::kNumber || (holds == StepHolds::kMaybe && !value.is_null()))
    return value.get<double>();
  if (holds == StepHolds::kNumbers) return value.get<std::vector<double>>();
  if (holds != StepHolds::kSpots) return value;
  Json spots = Json::array();
  for (const Json& spot : value) {
    spots.push_back({{"x_mm", spot["x_mm"].get<double>()},
                     {"y_mm", spot["y_mm"].get<double>()},
                     {"radius_mm", spot["radius_mm"].get<double>()}});
  }
  return spots;
}

Result<RecipeStep> step_from_json(const Json& object, const std::string& where) {
  if (!object.is_object() || !object.contains("do") || !object["do"].is_string())
    return unfit(where, "it does not say what to do");
  const std::string name = object["do"].get<std::string>();
  const auto kind =
      std::ranges::find(step_kinds(), name, [](const RecipeStepKind& k) { return std::string(k.name); });
  if (kind == step_kinds().end())
    return unfit(where,
                 fmt::format("there is no step {}; the nearest is {}", name, nearest_of(name, step_kinds())));
  RecipeStep step = {name, Json::object()};
  std::vector<std::string> known = {"do", "facts"};
  for (const StepKey& key : kind->keys) known.emplace_back(key.name);
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(known, key) == known.end())
      return unfit(fmt::format("{}: {}", where, key), no_such_key(known, key));
  }
  for (const StepKey& key : kind->keys) {
    const Json& value = object.contains(key.name) ? object[key.name] : key.otherwise;
    if (const std::optional<std::string> fault = fault_of(value, key))
      return unfit(fmt::format("{}: {}", where, key.name), *fault);
    step.options[key.name] = plain(value, key.holds);
  }
  return step;
}

bool is_kind(const std::string& name) {
  return std::ranges::any_of(step_kinds(), [&](const RecipeStepKind& kind) { return name == kind.name; });
}

// The list itself, or that of the recipe that is named.
Result<Json> listed_steps(const Json& document, const std::string& where) {
  if (!document.is_object() || document.contains("steps") == document.contains("recipe"))
    return unfit(where, "it has no list of steps");
  if (document.contains("steps")) {
    if (!document["steps"].is_array()) return unfit(where, "it has no list of steps");
    return document["steps"];
  }
  const Json& name = document["recipe"];
  const Recipe known = recipe_named(name.is_string() ? name.get<std::string>() : "");
  if (known.steps.empty())
    return unfit(where, fmt::format("recipe must be one of {}", fmt::join(recipe_names(), ", ")));
  return json_of(known)["steps"];
}

// Keys that stand under a step's name beside the steps.
Result<void> override_keys(const Json& document, const std::string& where, Json& steps) {
  for (const auto& [name, keys] : document.items()) {
    if (!is_kind(name)) continue;
    if (!keys.is_object() || keys.contains("do")) return unfit(where, name + " must be keys of that step");
    bool is_there = false;
    for (Json& step : steps) {
      if (!step.is_object() || step.value("do", Json()) != Json(name)) continue;
      step.update(keys);
      is_there = true;
    }
    if (!is_there) return unfit(where, fmt::format("none of its steps is {}", name));
  }
  return {};
}

}  // namespace

const std::vector<RecipeStepKind>& step_kinds() {
  static const std::vector<RecipeStepKind> kinds = {
      {"flatten",
       "Takes slow slopes out",
       {{"by",
         "a polynomial; one that follows errors in the corners too, and folds with them; or a high pass",
         StepHolds::kWord,
         "polynomial",
         0,
         0,
         {"polynomial", "corners", "high-pass"}},
        {"degree", "of the polynomial", StepHolds::kWhole, 3, 1, 5},
        {"cut_mm", "of the high pass: half of a wave of this length stays", StepHolds::kNumber, 20, 0.01,
         1e4},
        {"always", "also where the slow slope is within what the calibration does not know", StepHolds::kFlag,
         false}}},
      {"straighten",
       "Brings the weave's threads along rows and columns, bow and skew out",
       {{"turn_deg",
         "of the cloth in the picture, counterclockwise; left out: found, and over 15 asked about",
         StepHolds::kMaybe, nullptr, -90, 90},
        {"yarn_px", "width of the yarns beside each other and below each other; 0: found",
         StepHolds::kNumbers, Json::array({0, 0}), 0, 1000}}},
      {"crop",
       "Cuts to a rectangle",
       {{"left_mm", "from the left border", StepHolds::kNumber, 0, 0, 1e5},
        {"top_mm", "from the upper border", StepHolds::kNumber, 0, 0, 1e5},
        {"width_mm", "0: all that is right of it", StepHolds::kNumber, 0, 0, 1e5},
        {"height_mm", "0: all that is below", StepHolds::kNumber, 0, 0, 1e5}}},
      {"tile",
       "Cuts whole repeats that go on over their borders",
       {{"repeats", "across and down; 0: as many as fit", StepHolds::kNumbers, Json::array({0, 0}), 0,
         1000}}},
      {"repair",
       "Fills spots from other repeats",
       {{"spots", "from the left upper corner", StepHolds::kSpots, Json::array()}}},
      {"color",
       "Multiplies the albedo",
       {{"gain", "of red, green and blue", StepHolds::kNumbers, Json::array({1, 1, 1}), 0.01, 100},
        {"exposure", "in stops", StepHolds::kNumber, 0, -10, 10}}},
      {"scale",
       "Corrects the size of pixels, where it was typed or measured wrongly",
       {{"mm_per_pixel", "0: as it is", StepHolds::kNumber, 0, 0, 1000}}},
      {"detail", "Slopes with mean zero and albedo over its mean, to be laid over other maps", {}}};
  return kinds;
}

Result<Recipe> recipe_from_json(const Json& document, const std::string& where) {
  Result<Json> steps = listed_steps(document, where);
  if (!steps) return std::move(steps).error();
  if (steps->size() > kMostSteps) return unfit(where, fmt::format("it has over {} steps", kMostSteps));
  if (Result<void> ok = override_keys(document, where, *steps); !ok) return std::move(ok).error();
  Recipe recipe;
  for (std::size_t i = 0; i < steps->size(); ++i) {
    Result<RecipeStep> step = step_from_json((*steps)[i], fmt::format("{}: step {}", where, i + 1));
    if (!step) return std::move(step).error();
    recipe.steps.push_back(std::move(*step));
  }
  return recipe;
}

Json json_of(const Recipe& recipe) {
  Json steps = Json::array();
  for (const RecipeStep& step : recipe.steps) {
    Json object = {{"do", step.name}};
    object.update(step.options);
    steps.push_back(std::move(object));
  }
  return {{"steps", std::move(steps)}};
}

std::vector<std::string> recipe_names() {
  std::vector<std::string> names;
  for (const KnownRecipe& known : known_recipes()) names.emplace_back(known.name);
  return names;
}

Recipe recipe_named(const std::string& name) {
  Recipe recipe;
  const auto is_it = [&](const KnownRecipe& known) { return name == known.name; };
  const auto known = std::ranges::find_if(known_recipes(), is_it);
  if (known == known_recipes().end()) return recipe;
  for (const char* step : known->steps) {
    const auto kind = std::ranges::find_if(
        step_kinds(), [&](const RecipeStepKind& each) { return each.name == std::string(step); });
    recipe.steps.push_back({step, Json::object()});
    for (const StepKey& key : kind->keys)
      recipe.steps.back().options[key.name] = plain(key.otherwise, key.holds);
  }
  return recipe;
}

Result<Recipe> read_recipe(const fs::path& file) {
  if (Recipe known = recipe_named(file.string()); !known.steps.empty() && !is_there(file)) return known;
  if (!is_there(file) && !file.has_extension()) {
    return Error{ErrorKind::kNoInput, "there is no such recipe", file.string(),
                 fmt::format("no file of this name; weft's own nearest is {}",
                             nearest_of(file.string(), known_recipes())),
                 "name one of flat, tile, detail, or a file"};
  }
  if (file.extension() == ".json") {
    const Result<std::string> text = read_text(file);
    if (!text) return text.error();
    const Json document = Json::parse(*text, nullptr, false);
    if (document.is_discarded()) return unfit(file.string(), "it is no JSON");
    return recipe_from_json(document, file.string());
  }
  const Result<toml::table> table = read_toml(file);
  if (!table) return table.error();
  std::vector<std::string> known = {"step", "recipe"};
  for (const RecipeStepKind& kind : step_kinds()) known.emplace_back(kind.name);
  Json document = Json::object();
  for (const auto& [node_key, value] : *table) {
    const std::string key(node_key.str());
    if (std::ranges::find(known, key) == known.end())
      return unfit(fmt::format("{}: {}", file.string(), key), no_such_key(known, key));
    document[key == "step" ? "steps" : key] = weft::json_of(value);
  }
  if (table->empty()) document["steps"] = Json::array();
  return recipe_from_json(document, file.string());
}

}  // namespace weft::material
