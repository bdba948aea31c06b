// SPDX-License-Identifier: Apache-2.0
#include "material/usable.h"

#include <fmt/format.h>

#include <cmath>

namespace weft::material {
namespace {

// Names the first value that is not finite; empty where all are.
std::string not_finite(const Image<float>& map, const char* name) {
  for (int p = 0; p < map.planes(); ++p) {
    for (int y = 0; y < map.height(); ++y) {
      const float* const row = map.plane(p).row(y);
      for (int x = 0; x < map.width(); ++x) {
        if (!std::isfinite(row[x]))
          return fmt::format("{} is not finite at column {}, row {}, plane {}", name, x, y, p);
      }
    }
  }
  return "";
}

}  // namespace

Result<void> check_surface(const Surface& surface, int least_side, const std::string& what) {
  const auto refused = [&](std::string why, std::string remedy) {
    return Error{ErrorKind::kBadData, what, "cloth", std::move(why), std::move(remedy)};
  };
  const Size size = surface.size();
  if (size.width < least_side || size.height < least_side) {
    return refused(fmt::format("it is {} x {} pixels", size.width, size.height),
                   fmt::format("take a part of at least {0} x {0} pixels", least_side));
  }
  if (!(surface.mm_per_pixel > 0 && std::isfinite(surface.mm_per_pixel)))
    return refused("its pixels have no size in millimetres", "rectify the solve first");
  if (surface.slope.planes() != 2 || surface.albedo.planes() < 1 || surface.albedo.size() != size ||
      surface.status.size() != size || surface.sigma_deg.size() != size ||
      (!surface.opacity.empty() && surface.opacity.size() != size) ||
      (!surface.lobe.empty() && (surface.lobe.size() != size || surface.lobe.planes() != 4))) {
    return refused("its maps are not of one size", "make the maps again from one solve");
  }
  for (const auto& [map, name] : {std::pair{&surface.slope, "slope"},
                                  {&surface.albedo, "albedo"},
                                  {&surface.sigma_deg, "sigma"},
                                  {&surface.opacity, "opacity"},
                                  {&surface.lobe, "lobe"}}) {
    if (std::string why = not_finite(*map, name); !why.empty())
      return refused(std::move(why), "make the maps again from the solve");
  }
  return {};
}

}  // namespace weft::material
