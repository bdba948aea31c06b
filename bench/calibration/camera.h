// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct CalibrationCameraBenchOptions {
  int threads = 0;  ///< 0: all the machine has
  int seeds = 50;   ///< of the noise on projected corners; 2 to 10000
  int boards = 15;  ///< 5 to 100
  double sigma_px = 0.1;
  double rendered_megapixels = 2;  ///< of the photographs that corners are found in; 0: none
  double megapixels = 16;          ///< of the 20 photographs that are timed; 0: none
};

/// How well the camera is calibrated. A row a case and quantity, `asked` being the bar:
///
/// - "corners projected": a board of 17 x 11 corners in fixed poses, noise on its corners; the standard
/// deviation
///   `reached` over seeds, the Cramer-Rao `bound`, their `ratio` (asked: 1.3) and the mean error as `bias`.
/// - "photographs rendered": a ChArUco board of 18 x 12 squares through lens, blur, mosaic and noise; errors
///   against the simulator's camera, and of the corners.
/// - "time": `weft calibrate camera` on a folder of 20 photographs, five different ones four times over:
///   seconds, and as `ratio` over decoding the same files by as many threads.
Result<Rows> calibration_camera_table(const CalibrationCameraBenchOptions& options);

}  // namespace weft::bench
