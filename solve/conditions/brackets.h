// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/result.h"
#include "core/image/raw_frame.h"
#include "solve/conditions/conditions.h"
#include "solve/photographs/photographs.h"

namespace weft::solve {

/// One light at another exposure.
struct BracketShot {
  std::size_t light = 0;  ///< of the mosaics, from 0
  double ratio = 1;       ///< light that it gathered over that of the mosaic, as measured
  RawFrame frame;
};

/// Puts shots beside the mosaic of their light. A reading that only the shortest could take has its noise,
/// and one noise model speaks for all readings: it becomes the worst.
void join_brackets(std::vector<BracketShot> shots, Mosaics& mosaics);

/// Puts bracket shots beside the lit shot of their LED, by measured ratios of light.
Result<void> add_brackets(const Exposures& exposures);

}  // namespace weft::solve
