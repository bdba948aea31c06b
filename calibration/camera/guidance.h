// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "calibration/camera/boards.h"
#include "calibration/camera/lens_fit.h"
#include "calibration/camera/pose.h"
#include "core/rig/camera.h"

// Which photograph of a board is worth most after those that there are.

namespace weft::calibration {

struct GuidanceOptions {
  double start_focal_sigma = 0.05;  ///< of the focal length of `start`, relative
  /// Noise of a corner along x and along y, until three views show how much it is; and the least that they
  /// may show.
  double corner_sigma_px = 0.1, least_corner_sigma_px = 0.02;
  double asked_focal_percent = 0.02;  ///< sigma of the focal length
  double asked_place_mm = 0.02;       ///< sigma of a pixel's place on the table, rms over the frame
  int columns = 8, rows = 6;          ///< parts of the frame in each of which a corner was seen once
  double most_tilt_deg = 40;
  double lift_mm = 60;       ///< boards are also held this high
  double worth = 0.06;       ///< a photograph that lowers what is predicted by a smaller share adds little
  double most_alike = 0.75;  ///< of a pose with those that were photographed
};

/// What the photographs that there are let a calibration know, to first order.
struct LensForecast {
  double focal_percent = 0;
  double place_mm = 0;
};

/// How the board is to lie or be held: upright first, then tilted, its lowest edge `height_mm` over the
/// table.
struct BoardPose {
  double x_mm = 0, y_mm = 0;  ///< of its centre
  double tilt_deg = 0;
  double azimuth_deg = 0;  ///< of its normal's horizontal part, from x towards y; the other side is up
  double height_mm = 0;
  Pose rig_from_board;
  std::array<PixelPoint, 4> outline_px;  ///< where its squares' corners are then seen, from the upper left
  PixelPoint raised_px;                  ///< where the middle of its raised edge is seen
};

struct BoardGuidance {
  CameraModel camera;  ///< as far as it is known
  LensForecast now;
  std::vector<int> corners;  ///< by part of the frame, row by row
  int parts_seen = 0;        ///< that have a corner
  bool is_done = false;      ///< what is asked is met, and every part has been seen that a board can reach
  /// The photograph to take next. None where first the board is to lie flat on the table, where all is done,
  /// and where none adds much: then what is asked is more than this board and this camera give.
  std::optional<BoardPose> next;
  LensForecast then;                 ///< with that one
  std::vector<double> residuals_px;  ///< rms of each view by this camera
  std::vector<double> tilt_deg;      ///< of the board in each view to the table
  double table_tilt_deg = 0;         ///< of the view `table` to the table that `start` knew
  /// By part of the frame: where its corners were seen less where this camera has them, mean of all views; 0
  /// where there is none. Empty of fewer views than fit a camera.
  std::vector<PixelPoint> mean_residual_px;
  std::vector<double> alike;  ///< of each view with the one before it most like it: 1 is the same pose
};

/// Asks for the pose, of those in which the whole board is in the frame (5 x 5 places; level and tilted by 15
/// degrees, 30 and options.most_tilt_deg to eight sides; on the table and lifted), after which focal length
/// and a pixel's place on the table are predicted nearest to what is asked; once what is asked is met, or
/// none adds much to it, the one that shows most parts of the frame in which no corner was seen. The
/// information of a photograph is the Fisher information of its corners on focal lengths, principal point,
/// k1, k2, p1 and p2 after its own pose has followed (a Schur complement), on top of what `start` tells, its
/// principal point to a twentieth of the frame.
///
/// `start` is the camera as it was known before, from which poses of single views are found; it is refined
/// where three views or more allow it. `table` is the view in which the board lies on the table,
/// `thickness_mm` above it; without one the camera stands where `start` has it, and forecasts take such a
/// view for granted.
BoardGuidance guide_board(const Board& board, double thickness_mm, const CameraModel& start,
                          std::span<const BoardView> views, std::optional<std::size_t> table,
                          const GuidanceOptions& options = {});

/// What further photographs would let a calibration know: [0] after none, [1] after the one that
/// guide_board() would ask for next, each other after the best that can follow, `more` of them at most.
std::vector<LensForecast> forecasts_ahead(const Board& board, double thickness_mm, const CameraModel& start,
                                          std::span<const BoardView> views, std::optional<std::size_t> table,
                                          int more, const GuidanceOptions& options = {});

/// The board upright in this pose, its centre's height following from the rest.
BoardPose board_pose(const Board& board, const CameraModel& camera, BoardPose pose);

}  // namespace weft::calibration
