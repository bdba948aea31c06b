// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/camera/lens_fit.h"

// The least squares of fit_lens(): one camera, one pose a board.

namespace weft::calibration {

/// The name of a parameter that is the print's and not the camera's, for fit() and covariance_of().
inline constexpr const char* kLogStretch = "log_stretch";

/// All that is estimated. Corners of board i are at (u, v, board_z_mm[i]) in its own frame, where v is
/// stretched over u by exp(log_stretch) and their mean is not.
struct Bundle {
  CameraModel camera;  ///< its pose is not used
  std::vector<Pose> camera_from_board;
  std::vector<double> board_z_mm;
  double log_stretch = 0;
};

/// Brings fx, fy, cx, cy, the named terms (of distortion, and kLogStretch) and all poses to the least sum of
/// squares, by Gauss-Newton. Steps are halved where they would raise the sum. False where they lead nowhere.
bool fit(const std::vector<const BoardView*>& views, const std::vector<std::string>& distortion,
         Bundle& bundle);

/// sigma^2 (J^T J)^-1 of the camera's parameters and the pose of board `table`, all other poses being
/// estimated too, and kLogStretch where it is named; not finite where they cannot be told apart.
ParameterCovariance covariance_of(const std::vector<const BoardView*>& views,
                                  const std::vector<std::string>& distortion, const Bundle& bundle,
                                  std::size_t table, double corner_sigma_px);

/// Standard deviation of kLogStretch, one of `terms`; not finite where nothing tells it.
double stretch_sigma(const std::vector<const BoardView*>& views, const std::vector<std::string>& terms,
                     const Bundle& bundle, double corner_sigma_px);

/// Sum of squares of one board, its pose alone fitted from a start nearby.
std::optional<double> squares_with_pose_fitted(const BoardView& view, const CameraModel& camera,
                                               const Pose& start, double board_z_mm, double log_stretch = 0);

Pose pose_by_opencv(const BoardView& view, const CameraModel& camera);

/// Where a corner is in its board's frame.
Vec3 place_of(const BoardCorner& corner, double board_z_mm, double log_stretch);

/// Seen less predicted, by corner.
std::vector<PixelPoint> residuals_of(const BoardView& view, const CameraModel& camera,
                                     const Pose& camera_from_board, double board_z_mm,
                                     double log_stretch = 0);
/// Root of their mean square length; 0 of none.
double rms_of(const std::vector<PixelPoint>& residuals);

/// A focal length, principal point or distortion term by its name; null for any other.
double* number_of(CameraModel& camera, const std::string& parameter);
/// A step for its numerical derivative.
double step_of(const std::string& parameter);

}  // namespace weft::calibration
