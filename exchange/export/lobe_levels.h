// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "exchange/export/map_folder.h"

namespace weft::app {

/// The lobe of a cloth on a grid and on coarser ones: planes alpha, alpha_along, yarn_deg.
struct LobeOnGrid {
  Image<float> own;                   ///< of the grid itself; empty where that is the folder's
  std::vector<Image<float>> coarser;  ///< sides halved and rounded down, down to 1 x 1
};

/// Alphas are widened by the spread of the normals of all pixels beneath a texel, by the rule of the set's
/// own mips (material/filtering/roughness_mips). `size` is at most the folder's. Pixels without a solution
/// and holes count nowhere. Nothing where the folder has no normals or no roughness, or one that is 1
/// everywhere. Errors of read_image(); kBadData with the file for another size or a channel that is not
/// there.
Result<LobeOnGrid> lobe_on_grid(const MapFolder& folder, Size size, int threads);

}  // namespace weft::app
