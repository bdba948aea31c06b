// SPDX-License-Identifier: Apache-2.0
// Heights between pixels, a pixel a lane; compiled once for every SIMD target.

#if defined(WEFT_SOLVER_TRANSPORT_HEIGHTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WEFT_SOLVER_TRANSPORT_HEIGHTS_INL_H
#undef WEFT_SOLVER_TRANSPORT_HEIGHTS_INL_H
#else
#define WEFT_SOLVER_TRANSPORT_HEIGHTS_INL_H
#endif

#include <hwy/highway.h>

#include "solver/transport/heights.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using LaneTag = hn::CappedTag<float, kMostLanes>;
using Lanes = hn::Vec<LaneTag>;

// Heights of the same point beside each of the pixels from `from` on.
HWY_INLINE Lanes height_at(const float* from, std::ptrdiff_t stride, const PointBetween& point) {
  const LaneTag d;
  const float* above = from + point.upper_left;
  const float* below = above + stride;
  const Lanes right = hn::Set(d, point.right), down = hn::Set(d, point.down);
  const Lanes a = hn::LoadU(d, above), b = hn::LoadU(d, below);
  const Lanes upper = hn::MulAdd(right, hn::Sub(hn::LoadU(d, above + 1), a), a);
  const Lanes lower = hn::MulAdd(right, hn::Sub(hn::LoadU(d, below + 1), b), b);
  return hn::MulAdd(down, hn::Sub(lower, upper), upper);
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();

#endif
