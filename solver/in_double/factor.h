// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

#include "solver/in_double/pixel.h"

namespace weft::solver {

/// One light direction l with its weight w.
struct WeightedDirection {
  Eigen::Vector3d l;
  double w = 1;
  double x = 0;  ///< right-hand side
};

/// A solved system  min sum w (x - l . b)^2.
struct Factor {
  EquationsSolvedBy path = EquationsSolvedBy::kNothing;
  double condition = 0;     ///< of the rows sqrt(w) l; infinity where their rank is below three
  Eigen::Matrix3d inverse;  ///< (A^T W A)^-1
  Eigen::Vector3d b;
};

/// Solves by the cheapest factorisation that the condition number allows: see PixelSolver. Weights are
/// positive; only their ratios matter to the accuracy. Without a solution `path` is kNothing.
Factor factorise(std::span<const WeightedDirection> rows);

}  // namespace weft::solver
