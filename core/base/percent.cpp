// SPDX-License-Identifier: Apache-2.0
#include "core/base/percent.h"

#include <fmt/format.h>

namespace weft {

std::string percent_words(double share) {
  constexpr double kLeast = 0.001;
  const double percent = 100 * share;
  if (percent > 0 && percent < kLeast) return fmt::format("under {:g}", kLeast);
  return percent < 9.5 ? fmt::format("{:.2g}", percent) : fmt::format("{:.0f}", percent);
}

}  // namespace weft
