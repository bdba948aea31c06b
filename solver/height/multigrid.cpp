// SPDX-License-Identifier: Apache-2.0
#include "solver/height/multigrid.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/height/grid.h"
#include "solver/height/row_bands.h"

namespace weft::solver {
namespace {

// Two Jacobi steps with the roots of the Chebyshev polynomial over 0.4 to 2, the part of the spectrum that a
// coarser level cannot hold and a little more: the pair damps it 3.5-fold at least, before the cycle and
// after it. Unlike Gauss-Seidel it has no order, so bytes do not depend on threads, and it leaves the cycle
// symmetric.
constexpr float kDampings[2] = {0.5664f, 1.5763f};

// One V(2,2) cycle for the level's source, from height 0.
void v_cycle(std::vector<GridLevel>& levels, std::size_t l, int threads) {
  GridLevel& level = levels[l];
  relax_from_zero(level, kDampings[0], threads);
  relax(level, kDampings[1], threads);
  if (l + 1 == levels.size()) return;
  find_residual(level, threads);
  restrict_residual(level, levels[l + 1], threads);
  v_cycle(levels, l + 1, threads);
  add_from_coarse(levels[l + 1], level, threads);
  for (const float damping : kDampings) relax(level, damping, threads);
}

void fill_finest(const Slopes& slopes, const SlopeSurvey& survey, GridLevel& level, int threads) {
  const int width = slopes.size().width;
  for_each_band(slopes.size().height, threads, [&](int y0, int y1, int) {
    std::vector<double> source(static_cast<std::size_t>(width));
    StepWalk walk(slopes, survey, y0);
    for (int y = y0; y < y1; ++y) {
      if (y > y0) walk.advance();
      walk.source(source.data());
      std::transform(source.begin(), source.end(), level.source.row(y),
                     [](double v) { return static_cast<float>(v); });
      // The last of the row and all of the last row are 0, as the frame around the planes is.
      std::copy_n(walk.here().right_weight.begin(), width, level.left_weight.row(y) + 1);
      std::copy_n(walk.here().down_weight.begin(), width, level.upper_weight.row(y + 1));
    }
  });
}

double dot_of(const PaddedPlane& a, const PaddedPlane& b, int threads) {
  return sum_over_bands(a.size().height, threads, [&](int y0, int y1) {
    double sum = 0;
    for (int y = y0; y < y1; ++y) {
      const float *u = a.row(y), *v = b.row(y);
      for (int x = 0; x < a.size().width; ++x) sum += double{u[x]} * v[x];
    }
    return sum;
  });
}

// direction = height + keep * direction
void turn(const GridLevel& level, double keep, PaddedPlane& direction, int threads) {
  const auto factor = static_cast<float>(keep);
  for_each_band(level.size().height, threads, [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) {
      const float* z = level.height.row(y);
      float* p = direction.row(y);
      for (int x = 0; x < level.size().width; ++x) p[x] = z[x] + factor * p[x];
    }
  });
}

// scratch = A direction
void apply(GridLevel& level, const PaddedPlane& direction, int threads) {
  for_each_band(level.size().height, threads, [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) apply_row(level, direction, y, level.scratch.row(y));
  });
}

// solution += step * direction, source -= step * scratch
void advance(GridLevel& level, const PaddedPlane& direction, double step, View<float> solution, int threads) {
  const auto factor = static_cast<float>(step);
  for_each_band(level.size().height, threads, [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) {
      const float *p = direction.row(y), *ap = level.scratch.row(y);
      float *h = solution.row(y), *r = level.source.row(y);
      for (int x = 0; x < level.size().width; ++x) {
        h[x] += factor * p[x];
        r[x] -= factor * ap[x];
      }
    }
  });
}

}  // namespace

MultigridReport solve_weighted(const Slopes& slopes, const SlopeSurvey& survey, const Islands& islands,
                               double tolerance, int most_cycles, View<float> height, int threads) {
  std::vector<GridLevel> levels;
  levels.emplace_back(slopes.size());
  fill_finest(slopes, survey, levels.front(), threads);
  add_coarser_levels(levels, threads);
  GridLevel& finest = levels.front();
  PaddedPlane direction(slopes.size());
  const double start = std::sqrt(dot_of(finest.source, finest.source, threads));
  if (start == 0) return {};

  // Conjugate gradients: finest.source is the residual r, finest.height z = M^-1 r, direction p.
  MultigridReport report = {0, 1};
  double rz_before = 0;
  while (report.residual > tolerance && report.cycles < most_cycles) {
    v_cycle(levels, 0, threads);
    // What z holds of an island's free constant answers the rounding of r alone, and would outgrow the rest.
    islands.remove_means(finest.height.view(), threads);
    ++report.cycles;
    const double rz = dot_of(finest.source, finest.height, threads);
    turn(finest, rz_before > 0 ? rz / rz_before : 0, direction, threads);
    rz_before = rz;
    apply(finest, direction, threads);
    const double curvature = dot_of(direction, finest.scratch, threads);
    if (!(rz > 0) || !(curvature > 0)) break;  // nothing is left that floats can hold
    advance(finest, direction, rz / curvature, height, threads);
    report.residual = std::sqrt(dot_of(finest.source, finest.source, threads)) / start;
  }
  return report;
}

}  // namespace weft::solver
