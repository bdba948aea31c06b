// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "calibration/camera/boards.h"
#include "calibration/camera/pose.h"
#include "core/base/result.h"
#include "core/rig/camera.h"
#include "core/rig/lights.h"

// Lens and pose of the camera from photographs of one board in many poses.

namespace weft::calibration {

/// The board in one photograph.
struct BoardView {
  std::string name;
  std::vector<BoardCorner> corners;
};

struct LensOptions {
  std::size_t table = 0;    ///< the view in which the board lies on the table
  double thickness_mm = 0;  ///< of the board: the table is this far below what is printed
  std::size_t least_boards = 5;
  double most_focal_sigma = 0.003;  ///< predicted, over the focal length: above it the boards are too alike
  double most_misfit = 2;           ///< times the median residual of a board: left out above it
};

/// How well one set of distortion terms predicts boards that it was not fitted to.
struct LensTrial {
  std::string terms;       ///< "k1 k2 p1 p2"
  double held_out_px = 0;  ///< rms over boards, their poses fitted
  double better_by = 0;    ///< mean fall of the squared error a board against `than`, in its standard errors
  std::string than;        ///< terms it is measured against; empty for the first
  bool chosen = false;
};

struct BoardFit {
  Pose rig_from_board;
  double rms_px = 0;
  std::vector<PixelPoint> residual_px;  ///< seen less predicted, by corner
  bool used = true;                     ///< false: its residual is over LensOptions::most_misfit
};

/// How much longer the print's squares are down than across, as a share; their mean is taken for what was
/// told.
struct PrintStretch {
  double share = 0;
  double sigma = 0;      ///< infinite where the boards do not tell it
  bool is_used = false;  ///< it is above its noise, and places of corners were corrected by it
};

struct LensFit {
  CameraModel camera;
  /// fx, fy, cx, cy, the distortion terms that were fitted, and the pose as "camera_from_rig_rotation.x" ...
  /// (radians about the axes of the camera, moved() of calibration/camera/pose.h) and
  /// "camera_from_rig_translation_mm.x" ...: noise as the residuals show it.
  ParameterCovariance covariance;
  std::vector<BoardFit> boards;  ///< of every view, in their order
  std::vector<LensTrial> trials;
  double rms_px = 0;           ///< of the boards used
  double corner_sigma_px = 0;  ///< along x and along y, as the residuals show it
  PrintStretch print;
};

/// Fits focal lengths, principal point, distortion and all poses by least squares over all corners (Zhang,
/// PAMI 2000). cv::calibrateCamera finds them. Gauss-Newton on the same sum then goes to its minimum, to
/// 1e-9, and gives the covariance sigma^2 (J^T J)^-1, which OpenCV does not. k1 and k2 are always fitted; p1,
/// p2 and k3 where they lower the error of held-out boards (five folds) by over two standard errors.
///
/// Printers stretch by up to a percent along one side. Where that is above four times its own sigma and above
/// 0.05 percent, and lowers the error of held-out boards as above, it is fitted too.
///
/// The rig frame follows from the board on the table: origin at its centre, x along its rows, z = 0 at
/// thickness_mm below what is printed.
///
/// kBadData, with names of views: fewer than least_boards that fit each other, a board on the table that does
/// not fit, or boards that do not tell focal length from distance because all are parallel: the predicted
/// sigma of the focal length is the judge.
Result<LensFit> fit_lens(std::span<const BoardView> views, Size size, const LensOptions& options);

/// The camera with one parameter of its covariance changed.
CameraModel changed(CameraModel camera, const std::string& parameter, double by);

/// Standard deviation of what `value` says of a camera, to first order in its covariance.
double propagated(const CameraModel& camera, const ParameterCovariance& covariance,
                  const std::function<double(const CameraModel&)>& value);

/// The covariance that corners with this noise in x and y would give at the given cameras and poses: the
/// Cramer-Rao bound. `distortion` names the terms that are estimated besides fx, fy, cx, cy.
ParameterCovariance lens_bound(const CameraModel& camera, std::span<const Pose> rig_from_board,
                               std::span<const BoardView> views, std::size_t table,
                               const std::vector<std::string>& distortion, double corner_sigma_px);

/// In which of columns x rows parts of the frame a point lies, counted row by row.
std::size_t part_of_frame(const PixelPoint& px, Size size, int columns, int rows);
/// How many corners lie in each of these parts.
std::vector<int> corner_counts(std::span<const BoardView> views, Size size, int columns, int rows);

}  // namespace weft::calibration
