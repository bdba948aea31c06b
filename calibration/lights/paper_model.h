// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "calibration/camera/markers.h"
#include "calibration/lights/sheet.h"
#include "core/base/vec.h"
#include "core/rig/camera.h"
#include "core/rig/lights.h"

namespace weft::calibration {

// What a sheet of paper under one LED reads, as a model whose every number a fit can change:
//   ln r_kc(u) = ln(rho_c rho(U) Phi_kc) + g_kc(u) + mu_k ln(-l . aim_k) + ln(n . l) + ln f(n . l) - 2 ln d,
// at the point X where the line of sight of pixel u meets the sheet, U in the sheet's own coordinates, with
// d l = position_k - X and the paper's departure from Lambert's law f(c) = 1 - delta (1 - c).

/// Sheets of one kind of paper.
struct Paper {
  std::array<double, 3> reflectance_rgb = {1, 1, 1};
  /// Log of the albedo over that at the centre: terms in U, V, U^2, U V, V^2, U and V in [-1, 1] over
  /// the sheet's width and height.
  std::array<double, 5> log_albedo = {};
  double delta = 0;
  double half_width_mm = 148.5, half_height_mm = 105;
};

/// The part of a log reading that depends on place: all but fluxes, reflectance and gains; with derivatives.
struct PaperTerm {
  double log_value = 0;
  Vec3 by_position, by_aim;  ///< by_aim: of the unit vector's three components, to be kept at length 1
  double by_mu = 0;
  Vec3 by_turn, by_centre;  ///< of the sheet: as SheetPose::covariance has them
  std::array<double, 5> by_log_albedo = {};
  double by_delta = 0;
};

/// Nothing where the sheet is not seen, or the LED does not light it from the front.
std::optional<PaperTerm> paper_term(const LineOfSight& sight, const NearLight& led, const Paper& paper,
                                    const Pose& rig_from_sheet);

/// Frame coordinates in [-1, 1] that gains are functions of.
std::array<double, 2> frame_place(Size frame, double x_px, double y_px);

/// Everything that was on and above the table while sheets were photographed.
struct PaperScene {
  CameraModel camera;
  NearLights lights;
  Paper paper;
  std::vector<SheetPose> sheets;
  /// [sheet][led]: log of what the LED gave in that shot over its flux; empty: nothing of the kind.
  std::vector<std::vector<double>> shot_log_gains = {};

  double shot_log_gain(std::size_t sheet, std::size_t led) const {
    return shot_log_gains.empty() ? 0 : shot_log_gains[sheet][led];
  }
  /// Log of the reading of a channel at a pixel; nothing where paper_term() has nothing.
  std::optional<double> log_reading(std::size_t sheet, std::size_t led, int channel, double x_px,
                                    double y_px) const;
};

/// One average of paper. `led` is from 0.
struct PaperReading {
  std::size_t sheet = 0;
  std::size_t led = 0;
  double x_px = 0, y_px = 0;
  std::array<double, 3> reading_rgb = {};
  std::array<double, 3> relative_sigma = {};
};

}  // namespace weft::calibration
