// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/result.h"
#include "material/layers/field.h"

// Masks that follow the relief: dust lies in what is deep, wear takes off what is high.

namespace weft::material {

/// The values of a mask that become 0 and 1; in between it is straight. `zero` above `one` turns it over.
struct MaskLevels {
  double zero = 0, one = 1;
};
/// kUsage where both are alike.
Result<void> level(ParameterField& mask, const MaskLevels& levels);

struct CavityMaskOptions {
  double mm_per_pixel = 0;
  double radius_mm = 0.5;  ///< as in CavityOptions
  double range_mm = 0;     ///< likewise; 0: three times the rms
  bool is_tile = false;
  int threads = 0;
};
/// cavity() of a height: 0 deep, 0.5 flat, 1 high; of one that is the same everywhere 0.5.
Result<ParameterField> cavity_mask(const ParameterField& height_mm, const CavityMaskOptions& options);

/// 1 above `at_mm` and 0 below it, with 3 t^2 - 2 t^3 over `soft_mm` in between; a soft_mm of 0 is a step.
ParameterField height_mask(const ParameterField& height_mm, double at_mm, double soft_mm);

}  // namespace weft::material
