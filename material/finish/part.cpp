// SPDX-License-Identifier: Apache-2.0
#include "material/finish/part.h"

#include <algorithm>

namespace weft::material {
namespace {

template <typename T>
Image<T> map_within(const Image<T>& map, Rect part) {
  if (map.empty()) return {};
  Image<T> out({part.width(), part.height()}, map.planes());
  for (int p = 0; p < map.planes(); ++p) {
    for (int y = 0; y < part.height(); ++y)
      std::copy_n(map.plane(p).row(part.y0 + y) + part.x0, part.width(), out.plane(p).row(y));
  }
  return out;
}

}  // namespace

Surface part_of(const Surface& surface, Rect part) {
  Surface out;
  out.mm_per_pixel = surface.mm_per_pixel;
  out.slope = map_within(surface.slope, part);
  out.albedo = map_within(surface.albedo, part);
  out.sigma_deg = map_within(surface.sigma_deg, part);
  out.status = map_within(surface.status, part);
  out.opacity = map_within(surface.opacity, part);
  out.lobe = map_within(surface.lobe, part);
  return out;
}

}  // namespace weft::material
