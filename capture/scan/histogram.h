// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "capture/scan/scan.h"
#include "core/image/raw_frame.h"

namespace weft::capture {

/// Histograms of red, green and blue, from black to where the camera stops: as the frame knows, else as it
/// shows itself (find_count_stops()).
std::array<RawHistogram, 3> histogram_rgb(const RawFrame& frame);

/// How bright a frame is for the meter: shares of the same way, the largest of the three channels. A
/// photosite counts for no more than the brightest of its four neighbours of the same filter says, so that
/// hot ones do not count.
struct Brightness {
  double bright = 0;     ///< 99.9 percent of the photosites are below
  double brightest = 0;  ///< 99.999 percent
  double clipped = 0;    ///< share that the solver takes to be full (kSaturatedFrom of core/rig/radiometry.h)
};
Brightness brightness_of(const RawFrame& frame);

/// brightness_of() one test shot after another: what one shows of where the camera stops holds for those
/// after it.
class TestShotReader {
 public:
  Brightness read(RawFrame frame);

 private:
  std::array<float, 3> stops_ = {};
};

}  // namespace weft::capture
