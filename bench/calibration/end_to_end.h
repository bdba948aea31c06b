// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct CalibrationEndToEndBenchOptions {
  std::filesystem::path scene = "testdata/scenes/rig.toml";  ///< the rig, from where the program runs
  int threads = 0;
};

/// A rig calibrated from its own captures (simulator/captures.h): camera, response, lights and colour, one
/// after the other. Then, with no calibration but the tape measure, with lights by the seed's iteration, by
/// the pixel and by ours (misfits accepted, their chi-square told), and with the rig's truth but for colours:
/// grey planes of 20 degrees towards four sides are solved, and a cloth, and sheets that lights were not
/// fitted to are checked. Columns: the worst bias of normals at the centre and in the corners of the frame
/// (means of 64 pixels), slope gain over the frame, rms of a flat sheet and the slope gain of a tilted one,
/// and in squares of 32 pixels the mean relative error of a plane's albedo and the cloth's, and its
/// CIEDE2000. The last row says what is asked. About 600 MB of disk, and minutes.
Result<Rows> calibration_end_to_end_table(const CalibrationEndToEndBenchOptions& options);

}  // namespace weft::bench
