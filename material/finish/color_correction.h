// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/base/result.h"
#include "material/surface.h"

namespace weft::material {

/// Factors of the albedo, 0.01 to 100 each. Both are multiplied; they are recorded apart, since one is a
/// correction of colour and the other one of brightness.
struct ColorOptions {
  std::array<double, 3> white_gains = {1, 1, 1};  ///< of the planes
  double exposure = 1;
};

/// A cloth in other light, and how many of its pixels became brighter than a white sheet.
struct Colored {
  Surface surface;
  double share_above_white = 0;  ///< of pixels with an albedo over 1 in any plane; they stay as they are
};

/// kUsage for a factor out of range.
Result<Colored> color(Surface surface, const ColorOptions& options);

/// The same cloth with pixels of another size in millimetres: a correction of a scale that was typed or
/// measured wrongly. No pixel changes, and slopes neither: height and width scale together. kUsage for a
/// size that is not above 0.
Result<Surface> scale(Surface surface, double mm_per_pixel);

}  // namespace weft::material
