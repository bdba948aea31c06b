// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "app/jobs/calibrate/outcome.h"
#include "core/job.h"
#include "core/number.h"
#include "core/result.h"

namespace weft::app {

/// How lights are found from readings of paper.
enum class LightsMethod {
  kPhysical,  ///< a model of every LED, the paper and the poses (calibration/lights/physical.h)
  kPerPixel,  ///< its directions and intensities cell by cell (calibration/lights/per_pixel.h)
  kSeed,      ///< the iteration of seed 000 on one flat sheet (calibration/lights/seed_iteration.h)
};

inline constexpr NumberRange kTapeSigma_mm = {0.1, 1000}, kFlatness_deg = {0, 2},
                             kFlicker_percent = {0.01, 5};

struct CalibrateLightsOptions {
  std::filesystem::path input;   ///< *.weft, sheet.toml and, where a tape measured the LEDs, rig.toml
  std::filesystem::path from;    ///< the calibration to change: camera and response are needed
  std::filesystem::path output;  ///< the new one, which must not be there; empty: nothing is written
  LightsMethod method = LightsMethod::kPhysical;
  double tape_sigma_mm = 10;     ///< how well positions were measured, along each axis; kTapeSigma_mm
  double flatness_deg = 0.05;    ///< of the sheet's slow waves, rms; kFlatness_deg
  double flicker_percent = 0.3;  ///< of LEDs from shot to shot, where no sheet tells; kFlicker_percent
  bool lambertian = false;       ///< takes the paper to follow Lambert's law
  bool accept_misfit = false;    ///< writes the calibration although readings and model contradict each other
};

/// Measures the lights of a rig from sessions of a sheet of white paper in several poses, which its tags tell
/// (app/jobs/calibrate/sheet_captures.h), and writes a calibration with lights.json and report/lights.html.
/// Fluxes are absolute where sheet.toml gives the paper's reflectance. kPerPixel also writes the maps of each
/// LED to report/ (ledNN_direction.exr: X, Y, Z; ledNN_intensity.exr: R, G, B; a pixel a cell), and so does
/// kSeed.
///
/// Stains and folds of the paper are found, named and left out. Nothing is written unless all went well.
/// Errors beside those of reading: kUsage without `from` or with an option out of its range; kBadData for
/// paper of which more than a twentieth is faulty, and for a misfit (LightFit::misfits()) that is not
/// accepted. A calibration from one sheet is written with a warning and its predicted error.
Result<CalibrateOutcome> calibrate_lights(const CalibrateLightsOptions& options, const JobContext& context);

}  // namespace weft::app
