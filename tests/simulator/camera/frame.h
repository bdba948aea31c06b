// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/image/image.h"

namespace weft::simulator {

/// Pixels of the simulator's camera as it is by default.
inline constexpr Size kFrame = {2464, 1632};

inline std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace weft::simulator
