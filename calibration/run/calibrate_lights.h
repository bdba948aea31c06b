// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>

#include "calibration/run/calibrate_outcome.h"
#include "calibration/run/poses_price.h"
#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/describe/fields.h"

namespace weft::calibration {

/// How lights are found from readings of paper.
enum class LightsMethod {
  kPhysical,  ///< a model of every LED, the paper and the poses (calibration/lights/physical.h)
  kPerPixel,  ///< its directions and intensities cell by cell (calibration/lights/per_pixel.h)
  kSeed,      ///< the iteration of seed 000 on one flat sheet (calibration/lights/seed_iteration.h)
};
inline constexpr std::array<const char*, 3> kLightsMethodNames = {"physical", "per-pixel", "seed"};

struct CalibrateLightsOptions {
  std::filesystem::path input;  ///< *.weft, sheet.toml and, where a tape measured the LEDs, rig.toml
  std::filesystem::path from;   ///< camera and response are needed
  std::filesystem::path output;
  LightsMethod method = LightsMethod::kPhysical;
  double tape_sigma_mm = 10;
  double flatness_deg = 0.05;
  double flicker_percent = 0.3;
  bool lambertian = false;
  bool accept_misfit = false;
  PosesWish wish = {};
};
void describe(Fields& fields, CalibrateLightsOptions& options);

/// Measures the lights of a rig from sessions of a sheet of white paper in several poses, which its tags tell
/// (calibration/run/sheet_captures.h), and writes a calibration with lights.json and report/lights.html.
/// Fluxes are absolute where sheet.toml gives the paper's reflectance. kPerPixel also writes the maps of each
/// LED to report/ (ledNN_direction.exr: X, Y, Z; ledNN_intensity.exr: R, G, B; a pixel a cell), and so does
/// kSeed.
///
/// Stains and folds of the paper are found, named and left out. Nothing is written unless all went well.
/// Errors beside those of reading: kUsage without `from` or with an option out of its range; kBadData for
/// paper of which more than a twentieth is faulty, and for a misfit (LightFit::misfits()) that is not
/// accepted. A calibration from one sheet is written with a warning and its predicted error.
Result<CalibrateOutcome> calibrate_lights(const CalibrateLightsOptions& options, const JobContext& context);

/// What these sessions let that calibration know by kPhysical, and what more poses of the sheet would
/// (calibration/lights/poses_ahead.h): of a slope of 20 degrees, rms over the frame. Nothing is written.
/// Errors: as calibrate_lights() before it judges the fit, and choose_poses().
Result<PosesPrices> price_lights(const CalibrateLightsOptions& options, const JobContext& context);

}  // namespace weft::calibration
