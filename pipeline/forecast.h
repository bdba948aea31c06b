// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/result.h"
#include "pipeline/photographs.h"
#include "solver/gates/gates.h"
#include "solver/method.h"

namespace weft::pipeline {

/// The error that a level is expected to leave in the normals of a cloth, mean angles in degrees. There is no
/// truth to hold it against, so each part is what the sample tiles (solver/sample_tiles.h) let one see of it.
struct ErrorForecast {
  solver::Level level = solver::Level::kStandard;
  double noise_deg = 0;        ///< the solver's own sigma; of a preview, for the mean of four photosites
  double misfit_deg = 0;       ///< what the residuals have beyond noise: highlights, sheen, cast shadows
  double indirect_deg = 0;     ///< light from the cloth itself: it fits the model and shows in no residual
  double shortcut_deg = 0;     ///< how far a quicker level lies from `standard` beyond noise
  double calibration_deg = 0;  ///< the calibration's covariance, where there is one

  /// The parts are independent: root of the sum of their squares.
  double total_deg() const;
};

struct Forecast {
  solver::Gates gates;
  std::vector<ErrorForecast> levels;  ///< in the order of solver::Level
};

/// Forecasts the levels from what `least-squares`, `fast`, `standard` and `robust` make of the sample tiles.
/// Noise, of `standard`: rms of sigma over the samples. Misfit, likewise: a residual q, as a share of the
/// albedo, is worth an angle of q sqrt(n / (n - 3) tr(P G^-1 P)) with G the sum of l l^T over the n lights
/// and P across an upright normal, less the noise. Both are rms angles; the mean angle of a scatter alike in
/// both directions across the normal is sqrt(pi) / 2 of that. Quicker levels add their mean angle to
/// `standard`; a preview has the noise of four photosites and the mean normal of each cell. What `robust`
/// turns was misfit. Indirect: degrees from the gate of that name, of which `reference` leaves less where the
/// gate is open; two factors, fitted to simulated plain weaves without gloss (bench/accuracy/scenes.h, the
/// tuning set).
/// `weft bench explain` holds all of it against the truth: on held-out cloths within a factor 1.7 without
/// gloss, and from 0.4 to 1.6 of the truth with it, as residuals show only part of a highlight's harm.
/// Errors: as measure_gates and CalibrationSigmas::make.
Result<Forecast> forecast_errors(const Photographs& photographs, int threads);

}  // namespace weft::pipeline
