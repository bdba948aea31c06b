// SPDX-License-Identifier: Apache-2.0
#include "bench/maps/parts.h"

#include "bench/maps/detail.h"
#include "bench/maps/flatten.h"
#include "bench/maps/height.h"
#include "bench/maps/mips.h"
#include "bench/maps/occlusion.h"
#include "bench/maps/opacity.h"
#include "bench/maps/scans.h"

namespace weft::bench {

std::span<const MapsPart> maps_parts() {
  static constexpr MapsPart kParts[] = {
      {"height", "normals to heights in tiles and as a whole", maps_height},
      {"scans", "heights of solved normals, and of true ones", maps_scans},
      {"flatten", "slow errors of slopes, removed in each way", maps_flatten},
      {"occlusion", "line sweeps and horizon steps against rays", maps_occlusion},
      {"mips", "rules of roughness mips against shaded pixels", maps_mips},
      {"figures", "figures 17 to 20 of the scanner's paper as numbers", maps_figures},
      {"detail", "normals of a detail layer on a base", maps_detail},
      {"gloss", "roughness of a detail layer on a base", maps_gloss},
      {"opacity", "coverage from a light below", maps_opacity},
  };
  return kParts;
}

}  // namespace weft::bench
