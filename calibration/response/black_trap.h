// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/rig/calibration.h"

namespace weft::calibration {

/// What photographs of a black trap in a white sheet say: nothing in the trap sends light, so all that is
/// seen there came by way of the lens.
struct TrapReading {
  std::array<double, 3> share_rgb = {};  ///< Veil::share by channel, mean over the photographs
  Veil veil;                             ///< the mean of those; sigma by their scatter
  std::vector<Rect> places;              ///< where each photograph was read, its pixels
};

/// `pictures`: linear, planes R, G, B, black at 0, one photograph each; full pixels are +infinity. The trap
/// is the darkest square of a 32nd of the shorter side, and has to be three such squares wide, so that the
/// blur of its rim is left out. What it reflects itself counts as veil: velvet of 0.2 percent in full light
/// adds 0.002. kBadData where no picture has a trap: nothing as wide under a tenth of the frame's median.
Result<TrapReading> read_black_trap(const std::vector<Image<float>>& pictures);

}  // namespace weft::calibration
