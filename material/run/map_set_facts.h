// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/product.h"
#include "core/describe/fields.h"
#include "core/image/image.h"
#include "core/solve/verdict.h"
#include "material/run/map_facts.h"
#include "material/validation/validate.h"
#include "solve/session/current.h"
#include "solver/height/height.h"

// What maps.json says of a set of maps (weft.maps/1).

namespace weft::material {

inline constexpr ProductKind kMapsProduct = {"weft.maps", "maps.json", "set of maps",
                                             "make it first with weft maps"};

/// Words for solver::HeightMethod, in its order.
inline constexpr std::array<const char*, 4> kHeightMethodNames = {"tiled", "direct", "multigrid", "seed"};

/// How maps are derived.
struct DeriveOptions {
  /// kAutomatic: tile by tile, for maps of any size; of a tile the periodic solution.
  solver::HeightMethod height = solver::HeightMethod::kAutomatic;
  bool weighs_by_sigma = false;  ///< height: pixels count by one over the variance of their normal
  double cavity_mm = 2;          ///< radius that a cavity is seen against
  int directions = 8;            ///< of the occlusion's lines, 4 to 64
  /// Where the photographs do not tell the lobe it is that of this cloth (planned_cloths()); empty: of the
  /// session's kind of cloth, and where nobody said that, of cotton.
  std::string cloth;
};
/// As documents have them.
void describe(Fields& fields, DeriveOptions& options);

/// Where finished maps lie in those that they were made of: pixels from the left upper corner, x right and y
/// down.
struct FinishedPlace {
  std::array<double, 2> centre_px = {};
  std::array<double, 8> corners_px = {};  ///< x and y of each, from the left upper one clockwise
};

/// A step of the recipe, as it was told.
struct MapStep {
  std::string name;  ///< "tile"
  Json facts;        ///< what it found; null: nothing
  Json document;     ///< all of it, its options too
};

struct MapCheck {
  std::string name;
  Severity severity = Severity::kPassed;
  double number = 0, limit = 0;
  std::string text;
  std::string picture;  ///< a file beside it; empty: none
};

/// What was taken out of the rims of holes.
struct TableTakenOut {
  std::array<double, 3> albedo = {};  ///< of the table
  std::int64_t unmixed = 0, left = 0;
};

struct MapSetFacts {
  std::string id;
  solve::SourceFacts source;
  std::string rectified;  ///< id of the maps that they were made of
  Size size;
  double mm_per_pixel = 0;
  bool is_tile = false, is_preview = false;
  std::optional<FinishedPlace> place = {};  ///< none: of a set that does not say it
  std::vector<double> part_mm = {};         ///< as FinishingFacts has it
  std::vector<MapStep> steps = {};
  std::vector<MapFacts> maps = {};
  DeriveOptions derive = {};
  std::vector<MapCheck> checks = {};
  std::vector<Verdict> verdicts = {};
  std::optional<TableTakenOut> table = {};
  Json document = {};  ///< as it was read, so that fields of newer versions survive
};
void describe(Fields& fields, MapSetFacts& facts);
Json json_of(const MapSetFacts& facts);

/// Reads maps.json of a folder. kNoInput, kBadData.
Result<MapSetFacts> read_map_set(const std::filesystem::path& folder);

}  // namespace weft::material
