// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/lights/paper_model.h"
#include "core/base/result.h"
#include "core/rig/lights.h"

namespace weft::calibration {

// The lights of a rig from photographs of white paper in known poses (after Queau et al., JMIV 2018, who take
// a checkerboard's white squares): all LEDs at once, weighted least squares in the log of the readings
// (Ceres, Levenberg-Marquardt, Huber's loss), with everything that a single sheet cannot tell apart held
// by a prior whose width is in the covariance that comes out. We add the paper's departure from Lambert's
// law, without which LEDs are found millimetres away with a good fit of three poses, the poses of the sheets,
// which tags give to a twentieth of a degree and no better, and how much brighter or darker a LED was in each
// shot: LEDs flicker by tenths of a percent, which looks like a LED that stands nearer or farther.

/// Widths of the priors (one standard deviation), and what the fit may do.
struct LightFitOptions {
  double position_sigma_mm = 10;    ///< of the tape, along each axis
  double aim_sigma_deg = 30;        ///< of the aim that was assumed
  double mu_sigma = 1;              ///< of the lobe that was assumed
  double quadratic_sigma = 0.01;    ///< of each term of a LED's own log gain
  double spline_sigma = 0.5;        ///< of each coefficient of the shared log gain
  double spline_bend_sigma = 0.05;  ///< of third differences of its coefficients
  double log_albedo_sigma = 0.02;   ///< of each term of the paper's albedo
  double delta_sigma = 0.2;         ///< of the paper's departure from Lambert's law
  double flicker = 0.003;           ///< of a LED's log light from shot to shot; the readings tell better
  int spline_columns = 6;           ///< from 4
  int spline_rows = 4;              ///< from 4
  double unevenness = 0;            ///< of the paper's albedo, relative, over a few millimetres
  double flatness_deg = 0;          ///< of the paper: its waves, which count most under grazing light
  bool lambertian = false;          ///< holds delta at 0
  int most_iterations = 60;         ///< of each of up to five stages
  int threads = 1;
};

/// A shot whose light is not that of its LED's others.
struct OtherShot {
  std::size_t sheet = 0, led = 0;
  double log_gain = 0;  ///< over the light of the others, by readings alone
};

/// Chi-square per degree of freedom from which model and readings contradict each other: something moved, is
/// not flat, is not white paper, or does not shine as the model says.
inline constexpr double kMisfitFrom = 1.5;
/// A LED found so many standard deviations of the tape from where it was measured is not the one that was
/// measured.
inline constexpr double kAstrayFrom_sigmas = 5;
/// A fit is weak where a LED is not known better than this, along its worst axis.
inline constexpr double kWeakFrom_mm = 2;
/// A shot so many sigmas, and so many times LightFitOptions::flicker, brighter or darker than its LED's
/// others is no flicker.
inline constexpr double kOtherShotFrom_sigmas = 5;
inline constexpr double kOtherShotFrom = 3;
/// Flicker of more than so many times LightFitOptions::flicker is a model that does not fit.
inline constexpr double kMostFlicker = 1.5;

struct LightFit {
  PaperScene scene;  ///< lights, paper, sheets and shots as found; the shared log gains have mean 0 over the
                     ///< frame
  ParameterCovariance covariance;  ///< of the lights, times `inflation`; shared gains are not in it: they
                                   ///< scale albedo alone
  std::vector<SheetPose> sheets_before;
  std::vector<Vec3> position_sigma_mm;  ///< of each LED
  double delta_sigma = 0;
  double chi_square = 0;  ///< per degree of freedom, of readings and priors
  double degrees_of_freedom = 0;
  /// At least 1 and chi_square; more where neighbouring residuals are alike, as on wavy paper.
  double inflation = 1;
  bool leds_have_gains = false;  ///< else their own log gains are 0, and not in the covariance
  int iterations = 0;
  bool settled = false;  ///< whether one more step would change no parameter by a third of its sigma
  double flicker = 0;    ///< LightFitOptions::flicker as the readings show it
  bool flickers_too_much = false;                ///< kMostFlicker
  std::optional<OtherShot> other_shot;           ///< the worst, where there is one; from three sheets on
  std::vector<std::array<double, 3>> residuals;  ///< of each reading: log of measured over predicted

  double worst_position_sigma_mm() const;
  bool is_weak() const { return worst_position_sigma_mm() > kWeakFrom_mm; }
  bool misfits() const { return !settled || other_shot || flickers_too_much || chi_square > kMisfitFrom; }
};

/// Fits `start`: its lights are where the tape says (fluxes are not used), its sheets where tags say, its
/// paper's reflectance is what absolute scale rests on. Every reading is of a LED and a sheet of `start`.
/// A misfit is no error here: see LightFit::misfits(). kBadData where there are too few readings of a LED,
/// readings or weights that are not positive numbers, geometry that the model cannot light, no convergence,
/// or a LED that went astray.
Result<LightFit> fit_lights(const PaperScene& start, std::span<const PaperReading> readings,
                            const LightFitOptions& options);

}  // namespace weft::calibration
