// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <span>
#include <string>
#include <vector>

#include "bench/maps/facets.h"
#include "material/filtering/roughness_mips.h"

namespace weft::bench {

/// A way to make a texel.
struct MipContender {
  std::string name;
  material::MipRule rule;
  material::NormalWeight weight = material::NormalWeight::kProjected;
};

/// How footprints are looked at.
struct MipTrial {
  double alpha = 0.1;
  int across_px = 16, down_px = 16;  ///< beneath a texel
  double view_deg = 0;
  FacetLaw law = FacetLaw::kGgx;
  double lowest_light_deg = 90;       ///< lights no farther than this from the normal
  double highest_light_deg = 0;       ///< and no nearer
  int footprints = 100, lights = 64;  ///< of each of two azimuths of the view
  int texel_across_px = 0;  ///< what the texel was made of, where that is not what is seen; 0: the same
};

/// Relative rms by contender, and of the best single alpha of each footprint.
struct MipErrors {
  std::vector<double> by_contender;
  double best = 0;
  double alpha = 0;  ///< mean of the best
};
MipErrors mip_errors(const NormalSquare& cloth, const MipTrial& trial,
                     std::span<const MipContender> contenders, std::uint32_t seed);

}  // namespace weft::bench
