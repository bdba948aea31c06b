// SPDX-License-Identifier: Apache-2.0
#include "solver/transport/planes.h"

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

Vec3 normal_or_up(const Normals& normals, int column, int row) {
  const Vec3 n = {static_cast<double>(normals.x(column, row)), static_cast<double>(normals.y(column, row)),
                  static_cast<double>(normals.z(column, row))};
  const double size = length(n);
  if (!(n.z > 0) || !std::isfinite(size)) return {0, 0, 1};
  return (1 / size) * n;
}

}  // namespace weft::solver
