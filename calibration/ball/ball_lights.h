// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibration/ball/ball_shots.h"
#include "calibration/ball/outline.h"
#include "core/base/result.h"

// Lamps from balls that they light. Directions: x right, y up, z to the camera.

namespace weft::calibration {

enum class BallKind {
  kChrome,
  kGlossy,  ///< a polished ball of a black or coloured body, which mirrors as glass does
  kMatt,    ///< white
  kMirror   ///< chrome or glossy: nobody said which
};
inline constexpr std::array<const char*, 4> kBallKindNames = {"chrome", "glossy", "matt", "mirror"};
constexpr const char* name_of(BallKind kind) {
  return kBallKindNames[static_cast<std::size_t>(kind)];
}

/// What is known before.
struct BallOptions {
  std::vector<Circle> told = {};      ///< about where balls are; empty: they are looked for
  std::optional<BallKind> kind = {};  ///< none: chrome or matt as shots look. Strengths of mirrors need it
  double ball_mm = 0;                 ///< diameter; 0: not known, and no positions
  double fov_deg = 0;                 ///< of the picture's width; 0: seen from infinitely far away
};

/// Photographs under one lamp each, one plane, linear, 1 is full scale; of equal size.
struct BallPhotographs {
  std::vector<Image<float>> shots;
  std::vector<std::string> names;  ///< for errors
};

/// A ball and what its shots say.
struct FoundBall {
  Outline outline;
  BallKind kind = BallKind::kMirror;
  bool as_told = false;  ///< no edge was found near what was told, which stands as it is, +- 1 pixel
  Vec3 centre_mm;        ///< BallView::centre_mm; zero without a size
  std::vector<LampOnBall> lamps;
};

/// The lamp of one shot by all balls together.
struct FoundLamp {
  Vec3 direction;  ///< unit; where there is a position, from the middle of the picture
  double sigma_deg = 0;
  std::optional<Vec3> position_mm;  ///< from the middle of the picture, at the height of the balls' centres
  double position_sigma_mm = 0;
  /// Relative, mean 1; where there is a position, in the middle of the picture. None of clipped highlights.
  std::optional<double> strength;
  double strength_sigma = 0;
};

struct BallLights {
  std::vector<FoundBall> balls;
  std::vector<FoundLamp> lamps;  ///< one a shot
  double apart_deg = 0;  ///< mean angle between what two balls say: lamps are near, or balls badly seen
};

/// Errors, kBadData, name what is wrong: no ball; a ball that the picture cuts; one that moved; two lamps in
/// one shot; a shot whose lamp no ball shows.
Result<BallLights> lights_of_balls(const BallPhotographs& photographs, const BallOptions& options);

}  // namespace weft::calibration
