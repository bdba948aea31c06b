// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/parts.h"

#include "bench/maps/height.h"

namespace weft::bench {

std::span<const MapsPart> maps_parts() {
  static constexpr MapsPart kParts[] = {
      {"height", "normals to heights in tiles and as a whole", maps_height},
  };
  return kParts;
}

}  // namespace weft::bench
