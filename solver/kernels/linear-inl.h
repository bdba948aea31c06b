// SPDX-License-Identifier: Apache-2.0
// The row kernels of linear.cpp, compiled once for every SIMD target.

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "solver/kernels/finish-inl.h"
#include "solver/kernels/gather-inl.h"
#include "solver/kernels/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace weft::solver {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// One vector of pixels. Returns whether some lane asks to be solved again.
template <std::size_t kPlanes>
HWY_INLINE bool solve_columns(D d, const RowTask& task, const Scratch& scratch, std::size_t x) {
  const Columns columns(d, task, x);
  const V one = hn::Set(d, 1.0f);
  Sums<kPlanes> sums(d);
  Status status = hn::Zero(hn::RebindToSigned<D>());
  const bool all_count = gather(d, task, scratch, columns, sums);
  if (all_count && task.light_count > 3) {
    return finish<kPlanes, InUse::kAll>(
        d, task, scratch, x,
        {solved(d, sums.g, sums.rhs), sums.plane_rhs, sums.count, one, no_lane(d), status});
  }
  const Selection selection = select(d, task, scratch, columns, sums, status);
  mark(status, selection.shadowed, kShadowed);
  return finish<kPlanes, InUse::kSelected>(
      d, task, scratch, x,
      {solved(d, sums.g, sums.rhs), sums.plane_rhs, sums.count, one, selection.again, status});
}

template <std::size_t kPlanes>
bool solve_row(RowTask& task) {
  const D d;
  const Scratch scratch(d, task.scratch, task.light_count);
  bool again = false;
  for (std::size_t x = 0; x < task.width; x += hn::Lanes(d))
    again |= solve_columns<kPlanes>(d, task, scratch, x);
  return again;
}

bool solve_mosaic_row(RowTask& task) {
  return solve_row<1>(task);
}
bool solve_rgb_row(RowTask& task) {
  return solve_row<3>(task);
}

// Normal equations only; see solve_bare.
void solve_bare_row(const RowTask& task) {
  // Thirty streams are as many as the machine's own prefetcher follows.
  constexpr std::size_t kAhead = 64;
  const D d;
  for (std::size_t x = 0; x < task.width; x += hn::Lanes(d)) {
    const Along along(d, x);
    const V x_mm = along.at(d, task.points->x_mm), y_mm = along.at(d, task.points->y_mm);
    Symmetric g = zero_matrix(d);
    Vector3 rhs[3] = {zero_vector(d), zero_vector(d), zero_vector(d)};
    for (std::size_t k = 0; k < task.light_count; ++k) {
      const RowLight& light = task.lights[k];
      const Vector3 to_led = {hn::Sub(hn::Set(d, light.position[0]), x_mm),
                              hn::Sub(hn::Set(d, light.position[1]), y_mm), hn::Set(d, light.position[2])};
      const V d2 = dot(to_led, to_led);
      const V inverse_d = reciprocal_sqrt(d, d2);
      const Vector3 l = scaled(to_led, inverse_d);
      add_outer(g, l, l);
      for (std::size_t c = 0; c < 3; ++c) {
        const float* reading = task.readings[k * 3 + c] + x;
        hwy::Prefetch(reading + kAhead);
        const V r = hn::LoadU(d, reading);
        add_scaled(rhs[c], hn::Mul(r, hn::Mul(d2, hn::Set(d, light.inverse_flux[c]))), l);
      }
    }
    const Symmetric inverse = inverted(d, g).matrix;
    Vector3 b[3], sum = zero_vector(d);
    for (std::size_t c = 0; c < 3; ++c) {
      b[c] = times(inverse, rhs[c]);
      add_scaled(sum, hn::Set(d, static_cast<float>(kLuminance[c])), b[c]);
    }
    const V inverse_rho = reciprocal_sqrt(d, dot(sum, sum));
    const Vector3 n = scaled(sum, inverse_rho);
    hn::Stream(n.x, d, task.normal[0] + x);
    hn::Stream(n.y, d, task.normal[1] + x);
    hn::Stream(n.z, d, task.normal[2] + x);
    for (std::size_t c = 0; c < 3; ++c) hn::Stream(dot(n, b[c]), d, task.albedo[c] + x);
  }
  hwy::FlushStream();
}

}  // namespace HWY_NAMESPACE
}  // namespace weft::solver
HWY_AFTER_NAMESPACE();
