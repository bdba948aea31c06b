// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/result.h"

// A recipe: what is done to the maps of a solve, step by step, before other maps are derived from them. It
// names no session, so that it runs again on any solve (docs/finishing.md).

namespace weft::material {

/// One step, with all its options.
struct RecipeStep {
  std::string name;
  Json options;  ///< each key of its kind, in their order

  friend bool operator==(const RecipeStep&, const RecipeStep&) = default;
};

struct Recipe {
  std::vector<RecipeStep> steps;

  friend bool operator==(const Recipe&, const Recipe&) = default;
};

/// What an option of a step holds.
enum class StepHolds {
  kNumber,   ///< from `least` to `most`
  kMaybe,    ///< likewise, or null where nobody says one
  kWhole,    ///< a whole one
  kFlag,     ///< true or false
  kWord,     ///< one of `words`
  kNumbers,  ///< as many as its default has, each from `least` to `most`
  kSpots     ///< places to repair: a list of {x_mm, y_mm, radius_mm}
};

struct StepKey {
  const char* name;
  const char* says;  ///< for people, with its unit
  StepHolds holds;
  Json otherwise;
  double least = 0, most = 0;
  std::vector<std::string> words = {};
};

struct RecipeStepKind {
  const char* name;
  const char* says;
  std::vector<StepKey> keys;
};

/// All that a recipe may say.
const std::vector<RecipeStepKind>& step_kinds();

/// {"steps": [{"do": "tile", "repeats": [4, 3]}, ...]}, or {"recipe": "tile"} of one that weft brings along;
/// a step's name beside either has keys that take the place of that step's: {"straighten": {"turn_deg": 25}}.
/// Any other key of the object is passed over, so that a maps.json is a recipe too. Keys that a step lacks
/// have their default. kBadData with the step's number and the key; of an unknown name the nearest known one
/// is named.
Result<Recipe> recipe_from_json(const Json& document, const std::string& where);
Json json_of(const Recipe& recipe);

/// The names of the recipes that weft brings along, and each of them.
std::vector<std::string> recipe_names();
Recipe recipe_named(const std::string& name);

/// A file: TOML with a table [[step]] a step, else as the JSON above, or that JSON. Or the name of a recipe
/// that weft brings along (flat, tile, detail). kNoInput, kBadData.
Result<Recipe> read_recipe(const std::filesystem::path& file);

}  // namespace weft::material
