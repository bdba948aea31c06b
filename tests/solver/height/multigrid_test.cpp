// SPDX-License-Identifier: Apache-2.0
#include "solver/height/height.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "bench/oracles/oracle_rig.h"
#include "core/base/vec.h"
#include "solver/height/grid.h"
#include "tests/solver/height/surface.h"

namespace weft::solver {
namespace {

using test::height_of;
using test::normals_of;

// The minimum-norm solution of the weighted least-squares problem, written down pair by pair and solved
// densely: minimum norm is mean 0 over each island.
Eigen::VectorXd dense_height(const Image<float>& normals, const Image<std::uint8_t>& weight) {
  const Size size = normals.size();
  const auto index = [&](int x, int y) { return y * size.width + x; };
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size.pixels(), size.pixels());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size.pixels());
  const auto add_pair = [&](int xa, int ya, int xb, int yb, double step) {
    const double wa = weight(xa, ya), wb = weight(xb, yb);
    if (wa == 0 || wb == 0) return;
    const double w = 2 / (1 / wa + 1 / wb);
    const int a = index(xa, ya), b = index(xb, yb);
    matrix(a, a) += w;
    matrix(b, b) += w;
    matrix(a, b) -= w;
    matrix(b, a) -= w;
    right(a) -= w * step;
    right(b) += w * step;
  };
  const auto slope = [&](int x, int y, int axis) {
    return (axis == 0 ? -1.0 : 1.0) * normals(x, y, axis) / normals(x, y, 2);
  };
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (x + 1 < size.width) add_pair(x, y, x + 1, y, (slope(x, y, 0) + slope(x + 1, y, 0)) / 2);
      if (y + 1 < size.height) add_pair(x, y, x, y + 1, (slope(x, y, 1) + slope(x, y + 1, 1)) / 2);
    }
  }
  return matrix.completeOrthogonalDecomposition().solve(right);
}

TEST(Multigrid, IsTheDenseSolutionOnRandomMasksAndWeights) {
  test::Random random(11);
  for (const double share : {0.5, 0.65, 0.9}) {
    Image<float> normals = normals_of({15, 12}, test::weave_with_folds);
    test::add_noise(normals, 5, 12);
    Image<std::uint8_t> weight(normals.size());
    for (int y = 0; y < 12; ++y) {
      for (int x = 0; x < 15; ++x) {
        if (random.uniform() < share) weight(x, y) = static_cast<std::uint8_t>(1 + random.uniform() * 255);
      }
    }
    const Eigen::VectorXd want = dense_height(normals, weight);
    const Height height = height_of(normals, {.method = HeightMethod::kMultigrid}, weight.plane());
    for (int y = 0; y < 12; ++y) {
      for (int x = 0; x < 15; ++x) {
        EXPECT_NEAR(height.height_mm(x, y), want(y * 15 + x), 3e-6)
            << share << " inside, at " << x << ", " << y;
      }
    }
  }
}

TEST(Multigrid, IsTheCosineTransformToOnePartInAMillionAfterEightCycles) {
  const Image<float> normals = normals_of({256, 256}, test::weave_with_folds);
  const Height direct = height_of(normals, {.method = HeightMethod::kDct});
  const Height iterated =
      height_of(normals, {.method = HeightMethod::kMultigrid, .tolerance = 0, .most_cycles = 8});
  EXPECT_EQ(iterated.cycles, 8);
  EXPECT_LT(test::rms_difference(direct.height_mm.plane(), iterated.height_mm.plane()),
            1e-6 * test::rms_of(direct.height_mm.plane()));
}

TEST(Multigrid, LowersTheResidualFifteenfoldACycle) {
  for (const Size size : {Size{256, 256}, {301, 177}}) {
    const Height height = height_of(normals_of(size, test::weave_with_folds),
                                    {.method = HeightMethod::kMultigrid, .tolerance = 0, .most_cycles = 6});
    EXPECT_LT(height.residual, std::pow(15.0, -6)) << size.width << " x " << size.height;
  }
}

TEST(Multigrid, SolvesAThinSpiralThatFillsTheFrame) {
  // One line of single pixels, wound: the longest way the frame has, and nothing a coarse grid can see as
  // ground.
  const Size size = {41, 41};
  Image<std::uint8_t> mask(size);
  int x = 0, y = 0, dx = 1, dy = 0;
  const auto is_free = [&](int u, int v) {
    return u < 0 || v < 0 || u >= size.width || v >= size.height || mask(u, v) == 0;
  };
  for (int turns = 0; turns < 2;) {
    mask(x, y) = 1;
    const bool ahead = x + dx >= 0 && y + dy >= 0 && x + dx < size.width && y + dy < size.height &&
                       is_free(x + dx, y + dy) && is_free(x + 2 * dx, y + 2 * dy);
    if (ahead) {
      x += dx;
      y += dy;
      turns = 0;
    } else {
      dx = std::exchange(dy, dx) * -1;
      ++turns;
    }
  }
  // A surface of second degree, where the mean of two slopes is the step exactly.
  const auto saddle = [](double u, double v) {
    return test::SurfacePoint{0.01 * u * u - 0.008 * v * v, 0.02 * u, -0.016 * v};
  };
  const Height height = height_of(normals_of(size, saddle), {}, mask.plane());
  EXPECT_EQ(height.islands, 1);
  EXPECT_GT(height.pixels, 700);
  const double offset = height.height_mm(0, 0);
  for (y = 0; y < size.height; ++y) {
    for (x = 0; x < size.width; ++x) {
      if (mask(x, y) == 0) continue;
      EXPECT_NEAR(height.height_mm(x, y) - offset, saddle(x, y).height, 1e-4) << x << ", " << y;
    }
  }
}

TEST(Grid, RestrictionIsTheTransposeOfInterpolation) {
  for (const Size size : {Size{13, 10}, {8, 7}, {1, 5}}) {
    test::Random random(5);
    std::vector<GridLevel> levels;
    levels.emplace_back(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        levels[0].left_weight.row(y)[x] = x > 0 && random.uniform() < 0.7 ? 1.0f : 0.0f;
        levels[0].upper_weight.row(y)[x] = y > 0 && random.uniform() < 0.7 ? 1.0f : 0.0f;
        levels[0].scratch.row(y)[x] = static_cast<float>(random.uniform());
      }
    }
    add_coarser_levels(levels, 1);
    GridLevel &fine = levels[0], &coarse = levels[1];
    const auto dot = [](const PaddedPlane& a, const PaddedPlane& b) {
      double sum = 0;
      for (int y = 0; y < a.size().height; ++y) {
        for (int x = 0; x < a.size().width; ++x) sum += double{a.row(y)[x]} * b.row(y)[x];
      }
      return sum;
    };
    for (int y = 0; y < coarse.size().height; ++y) {
      for (int x = 0; x < coarse.size().width; ++x) {
        coarse.height.row(y)[x] = static_cast<float>(random.uniform());
      }
    }
    add_from_coarse(coarse, fine, 1);
    restrict_residual(fine, coarse, 1);
    EXPECT_NEAR(dot(fine.height, fine.scratch), dot(coarse.height, coarse.source), 1e-4);
  }
}

}  // namespace
}  // namespace weft::solver
