// SPDX-License-Identifier: Apache-2.0
#include "core/rig/exposure_words.h"

#include <fmt/format.h>

namespace weft {

std::string exposure_words(double exposure_us) {
  if (exposure_us < 1e3) return fmt::format("{:.4g} us", exposure_us);
  if (exposure_us < 1e6) return fmt::format("{:.4g} ms", 1e-3 * exposure_us);
  return exposure_us < 1e9 ? fmt::format("{:.4g} s", 1e-6 * exposure_us)
                           : fmt::format("{:.0f} s", 1e-6 * exposure_us);
}

}  // namespace weft
