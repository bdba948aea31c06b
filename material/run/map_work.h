// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/image/compression.h"
#include "core/image/image.h"
#include "core/solve/verdict.h"
#include "material/opacity/opacity.h"
#include "material/run/map_facts.h"
#include "material/run/map_set_facts.h"
#include "material/surface.h"

namespace weft::material {

/// A set of maps under way: what each is derived from, what is shared between them, and what was made.
struct MapWork {
  const Surface& surface;
  bool has_f0 = false;        ///< the lobe's f0 is measured, and not only its roughness
  bool is_size_known = true;  ///< else files state none
  std::filesystem::path folder = {};
  Compression compression = Compression::kNone;
  const DeriveOptions& options;
  const JobContext& context;

  std::string level = {};                        ///< of the solve; no remedy names it or one below
  bool is_colour_changed = false;                ///< by a step of the recipe
  std::optional<OpacityFacts> opacity = {};      ///< of surface.opacity
  double yarn_px = 0;                            ///< width of a yarn; 0: not known
  Image<float> height_mm = {};                   ///< once find_height() was asked
  Image<float> openness = {}, bent_normal = {};  ///< once find_openness() was asked
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

/// Side of a pixel that files state; 0 where it is not known.
double stated_mm(const MapWork& work);
/// The same of a coarser level of the surface.
PixelPitch pitch_of_level(const MapWork& work, Size level);

}  // namespace weft::material
