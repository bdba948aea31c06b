// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simulator/effects/passes.h"

namespace weft::simulator {

/// Fills `light` and `irradiance` from incidence_at(led, point) and irradiance_of(incidence, normal); the
/// dark shot has none.
template <typename IncidenceAt, typename IrradianceOf>
std::function<void(PassTile&)> lit_by(const IncidenceAt& incidence_at, const IrradianceOf& irradiance_of) {
  return [incidence_at, irradiance_of](PassTile& tile) {
    if (tile.led == 0) {
      std::fill(tile.light.begin(), tile.light.end(), Incidence{});
      std::fill(tile.irradiance.begin(), tile.irradiance.end(), 0.0);
      return;
    }
    const auto led = static_cast<std::size_t>(tile.led - 1);
    for (std::size_t i = 0; i < tile.light.size(); ++i) {
      const Incidence light = incidence_at(led, tile.point_mm[i]);
      tile.light[i] = light;
      tile.irradiance[i] = irradiance_of(light, tile.surface[i].normal);
    }
  };
}

}  // namespace weft::simulator
