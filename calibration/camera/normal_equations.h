// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <string>
#include <vector>

#include "calibration/camera/bundle.h"

// The least squares of a bundle to first order, for those who see Eigen.

namespace weft::calibration {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Columns6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;

inline constexpr double kTurnStep = 1e-6, kShiftStep_mm = 1e-4, kStretchStep = 1e-4;

/// fx, fy, cx, cy and these terms.
std::vector<std::string> camera_parameters(const std::vector<std::string>& distortion);

/// Where a camera whose own pose is unity sees a point of its frame.
PixelPoint seen_by(const CameraModel& camera, Vec3 in_camera_mm);
CameraModel at_origin(CameraModel camera);

/// The normal equations: camera by camera, camera by board, board by board, and gradients.
struct NormalEquations {
  Matrix camera;
  Vector camera_gradient;
  std::vector<Columns6> mixed;
  std::vector<Matrix6> board;
  std::vector<Vector6> board_gradient;
  double squares = 0;
};
NormalEquations normal_equations(const std::vector<const BoardView*>& views,
                                 const std::vector<std::string>& names, const Bundle& bundle);

/// What is left of the camera's equations once every pose follows its own (the Schur complement).
Matrix reduced(const NormalEquations& equations);

/// Solves with unit diagonal, as parameters differ by many powers of ten.
Matrix solved(const Matrix& normal, const Matrix& right);

/// The covariance of the camera's parameters and of the pose of board `table`, turn before shift, for corners
/// of unit noise, where `camera` is that of the camera's parameters.
Matrix with_pose_of(const NormalEquations& equations, std::size_t table, const Matrix& camera);

}  // namespace weft::calibration
