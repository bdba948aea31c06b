// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "simulator/scene/scene.h"

namespace weft::simulator {

/// Key of all random numbers of a scene.
inline std::array<std::uint32_t, 2> random_key(const Scene& scene) {
  const auto seed = static_cast<std::uint64_t>(scene.seed);
  return {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)};
}

/// Third number of a counter: the LED of the shot for what the sensor draws, else one of these, which no LED
/// has.
enum RandomStream : std::uint32_t {
  kYarnStream = 0xFFFFFFFF,
  kFlickerStream = 0xFFFFFFFB,  // those between belong to targets and bounces
};

}  // namespace weft::simulator
