// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace weft::solver {

Error bad_transport(std::string where, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "light between the yarns cannot be traced", std::move(where), std::move(why),
          std::move(remedy)};
}

bool holds_pixels(Rect outer, Rect inner) {
  return inner.x0 < inner.x1 && inner.y0 < inner.y1 && outer.x0 <= inner.x0 && inner.x1 <= outer.x1 &&
         outer.y0 <= inner.y0 && inner.y1 <= outer.y1;
}

Result<void> check_normals(const Normals& normals, Rect tile) {
  if (holds_tile(normals.x, tile) && holds_tile(normals.y, tile) && holds_tile(normals.z, tile)) return {};
  return bad_transport("normals", "a plane of the normals is smaller than the tile",
                       "give three planes of the tile's size");
}

Result<void> check_visibility(Rect tile, const LightDirections& lights,
                              std::span<const View<std::uint32_t>> visible) {
  if (!lights.at || lights.count == 0) {
    return bad_transport("lights", "there are none", "give the direction to at least one light");
  }
  if (visible.size() != static_cast<std::size_t>(visibility_words(lights.count)) ||
      !std::ranges::all_of(visible, [&](const auto& plane) { return holds_tile(plane, tile); })) {
    return bad_transport(
        "visibility",
        fmt::format("{} planes for {} lights, or planes smaller than the tile", visible.size(), lights.count),
        fmt::format("give {} planes of the tile's size", visibility_words(lights.count)));
  }
  return {};
}

Vec3 normal_or_up(const Normals& normals, int column, int row) {
  const Vec3 n = {static_cast<double>(normals.x(column, row)), static_cast<double>(normals.y(column, row)),
                  static_cast<double>(normals.z(column, row))};
  const double size = length(n);
  if (!(n.z > 0) || !std::isfinite(size)) return {0, 0, 1};
  return (1 / size) * n;
}

}  // namespace weft::solver
