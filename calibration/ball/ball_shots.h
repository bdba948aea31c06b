// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "calibration/ball/ball_view.h"
#include "core/image/image.h"

// What each photograph says of its lamp on one ball.

namespace weft::calibration {

/// The lamp of one shot.
struct LampOnBall {
  bool found = false;
  Vec3 direction;  ///< from the ball to the lamp
  Vec3 from;       ///< where that ray begins, in radii from the ball's centre
  double sigma_deg = 0;
  double x = 0, y = 0;     ///< where the ball mirrors it, or is brightest; pixels
  bool clipped = false;    ///< full scale was reached, so that a strength is too small
  bool is_double = false;  ///< a second highlight is as bright: two lamps
  /// Irradiance in arbitrary units, the same for all shots of a ball.
  double strength = 0;
  double strength_sigma = 0;
};

/// A ball read as one of the two kinds.
struct BallReading {
  std::vector<LampOnBall> lamps;  ///< one a shot
  double quality = 0;             ///< how well shots are those of such a ball, 0 to 1
};

/// Full scale; this much of it is clipped.
inline constexpr float kClippedFrom = 0.98F;

/// Chrome or glossy: the brightest compact spot of each shot over the median of all, which takes out what the
/// room leaves at one place. With n the normal there and v the direction to the camera, the lamp is at
/// 2 (n . v) n - v. `f0` is what it reflects at right angles: strengths are over Schlick's Fresnel factor.
BallReading read_mirror_ball(const std::vector<Image<float>>& shots, const Image<float>& median,
                             const BallView& view, double sigma_px, double f0);

/// Matt: I = g . n + a over lit pixels, least squares with Tukey's weights. The lamp is along g, its strength
/// |g|; a is light from all sides.
BallReading read_matt_ball(const std::vector<Image<float>>& shots, const BallView& view, double sigma_px);

}  // namespace weft::calibration
