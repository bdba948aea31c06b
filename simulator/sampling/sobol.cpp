// SPDX-License-Identifier: Apache-2.0
#include "simulator/sampling/sobol.h"

#include <array>

#include "simulator/sampling/random.h"

namespace weft::simulator {

Scramble scramble_of(std::uint64_t seed, int x, int y, std::uint32_t stream) {
  constexpr std::uint32_t kPurpose = 0x736f626fu;  // apart from the blocks that photon noise takes
  const std::array<std::uint32_t, 4> bits =
      philox({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), stream, kPurpose},
             {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  return {bits[0], bits[1]};
}

}  // namespace weft::simulator
