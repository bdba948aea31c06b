// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "solver/registration/registration.h"

namespace weft::solver {

/// How far readings lie from what explains them, as the round before found.
struct ResidualScale {
  double floor = 0;  ///< mean square, readings over strength; 0 where nothing is known yet
  double chi2 = 0;   ///< mean square over the expected variance; 0 where nothing is known yet
};

/// What one tile says of a group of G shots. Both are 2 G x 2 G and hold their lower triangle.
struct GroupInformation {
  Eigen::MatrixXd information;
  Eigen::MatrixXd noise;  ///< what noise in the gradients adds to it on average
};

/// The normal equations of one tile for displacements (x, y) of K shots, b eliminated at every point:
/// information * step = score.
struct TileSystem {
  std::vector<GroupInformation> groups;       ///< of consecutive shots, all of one size
  std::vector<Eigen::VectorXd> block_scores;  ///< 2 K each
  std::vector<Eigen::Matrix2d> cost;  ///< by shot: d . cost d = summed square angle, rad, of normals for d
  double points = 0;
  double readings = 0, shadowed = 0;  ///< usable readings at points, and those left out as in shadow
  double chi2 = 0;                    ///< summed squares of residuals over their expected variances
  double squares = 0;                 ///< summed squares of residuals
  double freedom = 0;                 ///< residuals less the three unknowns of each point
};

/// At the shots as seen through `shifts`. What shots of different groups say of each other by way of b is
/// left out: `group` shots are together, and divide their number.
TileSystem tile_system(const TileInput& tile, std::span<const ClothShift::Displacement> shifts,
                       const ResidualScale& scale, std::size_t group);

}  // namespace weft::solver
