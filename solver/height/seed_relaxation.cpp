// SPDX-License-Identifier: Apache-2.0
#include "solver/height/seed_relaxation.h"

#include <algorithm>
#include <vector>

#include "solver/height/grid.h"
#include "solver/height/row_bands.h"

namespace weft::solver {
namespace {

// Dx, Dy and which pixels have them, of one level.
struct SlopeLevel {
  explicit SlopeLevel(Size size) : right(size), down(size), weight(size) {}
  Size size() const { return right.size(); }
  PaddedPlane right, down, weight;
};

SlopeLevel finest_slopes(const Slopes& slopes, const SlopeSurvey& survey, int threads) {
  SlopeLevel level(slopes.size());
  for_each_band(slopes.size().height, threads, [&](int y0, int y1, int) {
    SlopeRow row;
    for (int y = y0; y < y1; ++y) {
      slopes.read(y, row);
      for (int x = 0; x < slopes.size().width; ++x) {
        const auto i = static_cast<std::size_t>(x);
        if (row.weight[i] == 0) continue;
        level.right.row(y)[x] = row.right[i] - survey.mean_right;
        level.down.row(y)[x] = row.down[i] - survey.mean_down;
        level.weight.row(y)[x] = 1;
      }
    }
  });
  return level;
}

SlopeLevel halved(const SlopeLevel& fine, int threads) {
  SlopeLevel level({(fine.size().width + 1) / 2, (fine.size().height + 1) / 2});
  const auto sum_of_four = [](const PaddedPlane& p, int x, int y) {
    const float *upper = p.row(2 * y) + 2 * x, *lower = p.row(2 * y + 1) + 2 * x;
    return (upper[0] + upper[1]) + (lower[0] + lower[1]);
  };
  for_each_band(level.size().height, threads, [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) {
      for (int x = 0; x < level.size().width; ++x) {
        const float count = sum_of_four(fine.weight, x, y);
        if (count == 0) continue;
        level.right.row(y)[x] = 2 * sum_of_four(fine.right, x, y) / count;
        level.down.row(y)[x] = 2 * sum_of_four(fine.down, x, y) / count;
        level.weight.row(y)[x] = 1;
      }
    }
  });
  return level;
}

// The guesses L, R, U and D of a pixel are its neighbours' heights plus steps: their mean is a Jacobi step of
// damping 1 for weights 1 and the sum of the steps as source.
GridLevel system_of(const SlopeLevel& slopes, bool signs_as_printed, int threads) {
  const Size size = slopes.size();
  GridLevel level(size);
  const float back = signs_as_printed ? 1.0f : -1.0f;
  for_each_band(size.height, threads, [&](int y0, int y1, int) {
    for (int y = y0; y < y1; ++y) {
      const float *here = slopes.weight.row(y), *above = slopes.weight.row(y - 1),
                  *below = slopes.weight.row(y + 1);
      const float *dx = slopes.right.row(y), *dy = slopes.down.row(y), *dy_above = slopes.down.row(y - 1);
      float *left_weight = level.left_weight.row(y), *upper_weight = level.upper_weight.row(y);
      for (int x = 0; x < size.width; ++x) {
        left_weight[x] = here[x] * here[x - 1];
        upper_weight[x] = here[x] * above[x];
        level.source.row(y)[x] = here[x] * (here[x - 1] * dx[x - 1] + here[x + 1] * back * dx[x] +
                                            above[x] * dy_above[x] + below[x] * back * dy[x]);
      }
    }
  });
  return level;
}

GridLevel height_from_slopes(const SlopeLevel& slopes, const RelaxationOptions& options, int threads) {
  if (slopes.size().pixels() == 1) return GridLevel(slopes.size());
  const GridLevel coarse = height_from_slopes(halved(slopes, threads), options, threads);
  GridLevel level = system_of(slopes, options.signs_as_printed, threads);
  add_from_coarse(coarse, level, threads);
  for (int i = 0; i < options.relaxations; ++i) relax(level, 1, threads);
  return level;
}

}  // namespace

void solve_as_seed(const Slopes& slopes, const SlopeSurvey& survey, const RelaxationOptions& options,
                   View<float> height, int threads) {
  const GridLevel level = height_from_slopes(finest_slopes(slopes, survey, threads), options, threads);
  for (int y = 0; y < height.height(); ++y) {
    std::copy_n(level.height.row(y), height.width(), height.row(y));
  }
}

}  // namespace weft::solver
