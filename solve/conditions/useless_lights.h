// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/result.h"
#include "solve/conditions/conditions.h"
#include "solve/photographs/photographs.h"

namespace weft::solve {

/// A photograph that says nothing of the cloth.
struct UselessLight {
  enum class Why {
    kSaturated,  ///< full on over 99 percent of the frame
    kNotLit,     ///< under 1 percent of what the best light gives of its predicted light
  };
  std::size_t light = 0;  ///< from 0
  Why why = Why::kNotLit;
  double full_share = 0;  ///< of the readings that were looked at
};

/// Looks at every 16th pair of rows of each photograph. Where no photograph stands five standard errors out
/// of the dark, none is called unlit. In the order of the lights.
std::vector<UselessLight> find_useless_lights(const Photographs& photographs);

/// Leaves out those of a rig's LEDs. kBadData where fewer than three remain.
Result<void> drop_useless_lights(const Exposures& exposures);

}  // namespace weft::solve
