// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace weft::report {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInf = std::numeric_limits<float>::infinity();

}  // namespace weft::report
