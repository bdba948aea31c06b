// SPDX-License-Identifier: Apache-2.0
#include "solver/kernels/weighted.h"

#include "solver/kernels/rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/kernels/weighted.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first.
#include <hwy/highway.h>

#include "solver/kernels/weighted-inl.h"

#if HWY_ONCE
namespace weft::solver {

HWY_EXPORT(solve_weighted_mosaic_row);
HWY_EXPORT(solve_weighted_rgb_row);

void solve_weighted(const TileInput& input, const TileOutput& output, Estimator estimator, double trim_from) {
  const PixelOptions options = {input.planes, true, input.noise, estimator, trim_from, input.plane_weights};
  solve_rows(input, output, options,
             input.planes == 1 ? HWY_DYNAMIC_DISPATCH(solve_weighted_mosaic_row)
                               : HWY_DYNAMIC_DISPATCH(solve_weighted_rgb_row));
}

}  // namespace weft::solver
#endif
