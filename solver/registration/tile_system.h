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

/// What one tile says of a group of G shots.
struct GroupInformation {
  Eigen::MatrixXd information;  ///< 2 G x 2 G; its lower triangle
  /// G x G, its lower triangle: what noise in the gradients adds on average, in x and y alike.
  Eigen::MatrixXd noise;
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

/// One shot of a tile, smoothed, as seen through a shift, at points that lie row by row.
struct SmoothShot {
  ClothShift::Displacement shift;
  std::vector<float> value, dx, dy;  ///< reading, and its slope a pixel
  double noise = 0;                  ///< variance of `value` for variance 1 of a reading
  double slope_noise = 0;            ///< of `dx`, and of `dy`
};

/// A tile as round after round looks at it: its lights and its smoothed shots are kept, 28 bytes a shot and
/// point, and a shot is smoothed anew only where it moved by more than its slopes can follow.
class TileShots {
 public:
  /// The tile must outlive it.
  explicit TileShots(const TileInput& tile) : tile_(tile) {}

  /// At the shots as seen through `shifts`. What shots of different groups say of each other by way of b is
  /// left out: `group` shots are together, and divide their number.
  TileSystem system_at(std::span<const ClothShift::Displacement> shifts, const ResidualScale& scale,
                       std::size_t group);

 private:
  struct Light {
    float x, y, z, over;  ///< direction, and one over its strength; 0 where there is none
  };
  void read_lights(std::size_t shots);

  const TileInput& tile_;
  std::vector<Light> lights_;  ///< [point * shots + shot]
  std::vector<SmoothShot> smoothed_;
};

}  // namespace weft::solver
