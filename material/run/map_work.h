// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job.h"
#include "core/base/result.h"
#include "core/image/compression.h"
#include "core/image/image.h"
#include "core/solve/verdict.h"
#include "material/opacity/opacity.h"
#include "material/run/map_facts.h"
#include "material/surface.h"
#include "solver/height/height.h"
#include "solver/reflectance/lobe.h"

namespace weft::app {

/// Words for solver::HeightMethod, in its order.
inline constexpr std::array<const char*, 4> kHeightMethodNames = {"tiled", "direct", "multigrid", "seed"};

/// How maps are derived.
struct DeriveOptions {
  /// kAutomatic: tile by tile, for maps of any size; of a tile the periodic solution.
  solver::HeightMethod height = solver::HeightMethod::kAutomatic;
  bool weighs_by_sigma = false;  ///< height: pixels count by one over the variance of their normal
  double cavity_mm = 2;          ///< radius that a cavity is seen against
  int directions = 8;            ///< of the occlusion's lines, 4 to 64
  /// Where the photographs do not tell the lobe it is that of this cloth (planned_cloths()).
  std::string cloth = "cotton";
};

/// A set of maps under way: what each is derived from, what is shared between them, and what was made.
struct MapWork {
  const material::Surface& surface;
  bool has_f0 = false;  ///< the lobe's f0 is measured, and not only its roughness
  std::filesystem::path folder = {};
  Compression compression = Compression::kNone;
  const DeriveOptions& options;
  const JobContext& context;

  std::string level = {};                              ///< of the solve; no remedy names it or one below
  bool is_colour_changed = false;                      ///< by a step of the recipe
  std::optional<material::OpacityFacts> opacity = {};  ///< of surface.opacity
  double yarn_px = 0;                                  ///< width of a yarn; 0: not known
  Image<float> height_mm = {};                         ///< once find_height() was asked
  Image<float> openness = {}, bent_normal = {};        ///< once find_openness() was asked
  std::vector<MapFacts> made = {};
  std::vector<Verdict> verdicts = {};
};

/// Writes the planes as the file that `facts` names, half floats but for millimetres, with a picture, and
/// adds the map to what was made.
Result<void> write_map(MapWork& work, MapFacts facts, const std::vector<View<const float>>& planes);
/// A map that is a file of the surface already: its range and its picture.
Result<void> draw_map(MapWork& work, MapFacts facts, const std::vector<View<const float>>& planes);
/// A map that is one number.
void write_constant(MapWork& work, MapFacts facts, double value, std::string why);

/// Of a pixel of a coarser level of this surface.
PixelPitch pitch_of_level(const material::Surface& surface, Size level);

/// Integrates the slopes, once.
Result<void> find_height(MapWork& work);

/// What the relief hides of the sky, once.
Result<void> find_openness(MapWork& work);

// Each makes the map of its name.
Result<void> make_height(MapWork& work);
Result<void> make_curl(MapWork& work);
Result<void> make_occlusion(MapWork& work);
Result<void> make_cavity(MapWork& work);
Result<void> make_roughness(MapWork& work);
Result<void> make_gloss(MapWork& work);
Result<void> make_mips(MapWork& work);
Result<void> make_detail(MapWork& work);
Result<void> make_opacity(MapWork& work);

/// What can be derived from a surface.
struct DerivedMap {
  const char* name;
  const char* says;
  Result<void> (*make)(MapWork& work);
};
const std::vector<DerivedMap>& derived_maps();

}  // namespace weft::app
