// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct TransportOptions {
  double megapixels = 0.5;  ///< of the picture that a whole round is measured on
  int threads = 0;          ///< of that round, 0: all the machine has; all else is of one thread
};

/// Cost and error of solver/transport and of rays (bench/oracles/rays) on the deep weave, ten pixels a yarn,
/// under ten LEDs 600 mm away:
///   grid      a block's height grid
///   shadows   visibility of ten lights by rays
///   gather    arriving light of ten lights at albedo 0.5 from 8 to 128 rays
///   slices    the same light from 8 to 64 directions
///   openness  by 4 x 8 and 8 x 16 horizon steps
///   round     grids, shadows and 32 rays for all blocks of the picture
/// `ratio` is ns_per_ray over bare_ns: Embree's robust quads of the same heights with the same rays ready in
/// its own structures and in the cache, one by one or in packets of 16, whichever is quicker. ns_per_ray is
/// everything: making rays, tracing them, adding up. Errors are against 4096 rays, in shares of what a facing
/// white surface would receive (gather) or of the sky (openness); bytes_per_pixel is Embree's memory a pixel
/// of the block, halo included.
Result<Rows> transport(const TransportOptions& options);

}  // namespace weft::bench
