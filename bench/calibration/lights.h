// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "bench/base/report.h"
#include "core/result.h"
#include "report/plot_svg.h"

namespace weft::bench {

struct CalibrationLightsBenchOptions {
  int threads = 0;         ///< 0: all the machine has
  int seeds = 5;           ///< of noise, tape and poses; 1 to 1000
  double megapixels = 16;  ///< of the 55 photographs that are timed; 0: none
};

/// How well the lights are found from averages of white paper (26 x 17 blocks, 0.2 percent noise, tape 10 mm
/// wrong, poses off by 0.05 degrees and 0.1 mm; ten LEDs of differing aim and lobe, a vignette, uneven
/// paper), made by formulas of their own (bench/oracles/paper_oracle.h). A row a quantity, `asked` being the
/// bar, root mean square over the seeds, or the worst where it says so:
///
/// - "five poses", the paper Lambertian or not: positions, directions, iterations, chi-square, delta; and
///   in how many seeds the gate fires where delta is held at 0.
/// - "flicker": LEDs that differ from shot to shot: how many seeds are accepted, the error of positions, what
///   it is predicted to be, the error over its sigma, and the flicker that was found.
/// - "weft calibrate lights, flicker": the program on simulated sessions of five poses whose LEDs flicker and
///   fade, up to three seeds: how many are accepted, the error of positions over their sigma, and how many
///   different lights.json one input makes in five runs.
/// - "method": what lights by the tape alone, by the seed, by the pixel and by ours make of a slope of 20
///   degrees at the centre, in the corners and over the frame, the gain of slopes, and the minutes they take:
///   two a pose at the rig (an estimate), and the fit.
/// - "N poses": normals at a slope of 20 degrees over the frame, as the covariance predicts them and as they
///   are, and the minutes. Both of the paper that is not Lambertian.
/// - "time": `weft calibrate lights` on five sessions of ten LEDs: seconds, as ratio to decoding the same
///   files, and the peak of memory.
Result<Rows> calibration_lights_table(const CalibrationLightsBenchOptions& options);

/// The error of normals in these rows against the minutes: predicted and true from one pose to nine, and the
/// other methods.
report::Plot calibration_poses_plot(const Rows& rows);
/// Writes it to `folder`/pictures/calibration_poses.svg.
Result<void> write_calibration_docs(const std::filesystem::path& folder, const Rows& rows);

}  // namespace weft::bench
