// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "bench/oracles/paper_oracle.h"
#include "calibration/lights/grey_chart.h"

namespace weft::test {

/// What is wrong with a chart of the nine greys of the Munsell scale that lies on the table of a PaperRig, in
/// standard deviations drawn anew for each seed: the defaults are what calibration::GreyChartOptions expect.
struct GreyErrors {
  double reflectance = 0.01;  ///< relative, of each patch
  double tilt_deg = 0.1, height_mm = 0.2;
  double delta = 0.02;    ///< departure from Lambert's law
  double noise = 0.002;   ///< relative, of each reading
  double stray = 0.0005;  ///< of white
  double bend = 0;        ///< v (1 + bend v) is read where light is v; no standard deviation
  std::uint64_t seed = 1;
};

struct GreyCapture {
  std::vector<calibration::GreyPatch> patches;  ///< in a row of 144 mm across the middle of the frame
  std::vector<double> full_reading;             ///< that puts the brightest reading at 80 percent
};

/// By the formulas of PaperRig::reading(). `rig.sheets` and its paper are not used.
GreyCapture greys_of(PaperRig rig, const GreyErrors& errors);

}  // namespace weft::test
