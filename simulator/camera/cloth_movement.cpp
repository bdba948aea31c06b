// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/cloth_movement.h"

#include <cmath>

#include "simulator/camera/streams.h"
#include "simulator/sampling/random.h"

namespace weft::simulator {

ClothMovement movement_of_shot(const MovementSettings& settings, int shot, std::array<std::uint32_t, 2> key) {
  const auto number = static_cast<std::uint32_t>(shot);
  const NormalPair shift = normal_pair(philox({number, 0, 0, kMovementStream}, key));
  const NormalPair turn = normal_pair(philox({number, 1, 0, kMovementStream}, key));
  const double angle = radians(settings.sigma_deg * turn.first);
  return {std::cos(angle), std::sin(angle), settings.sigma_mm * shift.first,
          settings.sigma_mm * shift.second};
}

}  // namespace weft::simulator
