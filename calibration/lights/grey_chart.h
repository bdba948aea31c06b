// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/rig/camera.h"
#include "core/rig/lights.h"

namespace weft::calibration {

// How bright each LED is by channel, which is its white balance, from a flat chart of matte greys of measured
// reflectance (seed 000, "Light calibration", where it is I / l_y) under LEDs whose places are known. Since
// the light on every patch is known but for its strength, a bent response shows as well.

struct GreyPatch {
  double x_px = 0, y_px = 0;                       ///< of its centre
  double reflectance = 0;                          ///< of a perfect diffuser, in all channels; above 0
  std::vector<std::array<double, 3>> reading_rgb;  ///< by LED; what is not a positive number is not used
};

/// How the chart lies and what is not known of it, as standard deviations.
struct GreyChartOptions {
  double height_mm = 0;  ///< of its patches above the table
  double height_sigma_mm = 0.2;
  double tilt_sigma_deg = 0.1;      ///< about each axis of the table
  double reflectance_sigma = 0.01;  ///< relative, of each patch by itself
  double delta = 0;                 ///< it reflects 1 - delta (1 - n . l) of Lambert's law
  double delta_sigma = 0.02;
  double reading_sigma = 0.002;  ///< relative, of each mean of a patch
  double stray = 0.0005;         ///< light on every patch, over what a perfect diffuser would reflect there
};

struct GreyChartFit {
  NearLights lights;  ///< with the fluxes that were found
  /// Relative, of each flux and of red and blue over green. For LEDs at the places they are said to be at.
  std::vector<std::array<double, 3>> flux_sigma;
  std::vector<std::array<double, 2>> balance_sigma;
  std::vector<double> log_flux_covariance;  ///< LEDs by LEDs, of the means of the channels' logs
  std::vector<double> off_percent;          ///< of each patch, from its reflectance
  /// Linear light is v (1 + bend v) for v as it was read, from 0 to 1; 0 for a straight response. The fluxes
  /// are those of a straight one.
  double bend = 0, bend_sigma = 0;
  double chi_square = 0;  ///< a degree of freedom; all that is a sigma is inflated by its root above 1
};

/// Weighted least squares in the logs of the readings, once around the lights as given: the covariance is the
/// Cramer-Rao bound. `full_reading[k]` is what full scale reads in the photograph of LED k.
/// Errors: kUsage for numbers that do not fit each other or are out of range; kBadData, with its name, for a
/// LED whose light fewer than three patches show in some channel.
Result<GreyChartFit> fit_grey_chart(const CameraModel& camera, const NearLights& lights,
                                    std::span<const GreyPatch> patches, std::span<const double> full_reading,
                                    const GreyChartOptions& options = {});

}  // namespace weft::calibration
