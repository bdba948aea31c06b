// SPDX-License-Identifier: Apache-2.0
#include "simulator/geometry/geometry_settings.h"

#include <cmath>
#include <string>
#include <utility>

namespace weft::simulator {

GeometrySettings family_settings(Family family) {
  GeometrySettings g;
  g.kind = GeometryKind::kPlain;
  switch (family) {
    case Family::kSmooth:
      g.flank_deg = 15.5;
      g.crimp = 0.022;
      break;
    case Family::kPlain:
      g.flank_deg = 26;
      g.crimp = 0.13;
      g.flatness = 0.2;
      break;
    case Family::kDeep:
      g.flank_deg = 61;
      g.crimp = 0.18;
      g.twist_relief = 0.04;
      break;
  }
  return g;
}

Result<void> check_heights(const GeometrySettings& g) {
  if (g.kind != GeometryKind::kHeightMap) return {};
  const auto refuse = [](std::string why, std::string remedy) {
    return Error{ErrorKind::kBadData, "height map cannot be used", "geometry.height_map", std::move(why),
                 std::move(remedy)};
  };
  const Image<float>* heights = g.heights_mm.get();
  if (heights == nullptr || heights->empty()) return refuse("it has no heights", "name a picture of heights");
  if (heights->planes() != 1)
    return refuse("it has " + std::to_string(heights->planes()) + " planes, not 1", "give it one plane");
  for (int y = 0; y < heights->height(); ++y) {
    for (int x = 0; x < heights->width(); ++x) {
      if (std::isfinite((*heights)(x, y))) continue;
      return refuse("column " + std::to_string(x) + ", row " + std::to_string(y) + " is not a finite number",
                    "fill its holes");
    }
  }
  return {};
}

}  // namespace weft::simulator
