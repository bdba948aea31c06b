// SPDX-License-Identifier: Apache-2.0
#include "solve/input/light_axes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace weft::solve {
namespace {

constexpr double kLowest = -0.05;  // z of a lamp at the edge of the table
constexpr std::size_t kMostNamed = 8;

Vec3 flipped(LightFlip flip, const Vec3& v) {
  switch (flip) {
    case LightFlip::kNone:
      break;
    case LightFlip::kX:
      return {-v.x, v.y, v.z};
    case LightFlip::kY:
      return {v.x, -v.y, v.z};
    case LightFlip::kZ:
      return {v.x, v.y, -v.z};
    case LightFlip::kAll:
      return {-v.x, -v.y, -v.z};
    case LightFlip::kLeft:
      return {-v.y, v.x, v.z};
    case LightFlip::kRight:
      return {v.y, -v.x, v.z};
    case LightFlip::kExchange:
      return {v.y, v.x, v.z};
    case LightFlip::kAgainst:
      return {-v.y, -v.x, v.z};
    case LightFlip::kHalf:
      return {-v.x, -v.y, v.z};
  }
  return v;
}

}  // namespace

Result<void> lay_lights(LightFlip flip, const std::filesystem::path& source, DistantLights& lights) {
  std::vector<std::size_t> below;
  for (std::size_t k = 0; k < lights.lights.size(); ++k) {
    Vec3& direction = lights.lights[k].direction;
    direction = flipped(flip, direction);
    if (direction.z < kLowest) below.push_back(k + 1);
  }
  if (below.empty()) return {};
  const bool are_all = below.size() == lights.lights.size();
  const std::size_t count = below.size();
  below.resize(std::min(count, kMostNamed));
  return Error{
      ErrorKind::kBadData, "lights lie below the table", source.string(),
      are_all ? "z is negative in all of them, and the camera is on the side where z is positive"
              : fmt::format("z is negative in {} of {}: {}{}", count, lights.lights.size(),
                            fmt::join(below, ", "), count > kMostNamed ? ", ..." : ""),
      are_all ? "say --flip z if z points away from the camera, or --flip all if the vectors point from the "
                "light to the cloth"
              : "mend their directions, or leave these photographs out with --lights"};
}

}  // namespace weft::solve
