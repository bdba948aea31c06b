// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "virtual_rig/ptp/virtual_camera.h"

namespace weft::virtual_rig {

/// Light that comes and goes in time. Its mean over a period is 1: it takes nothing from a light, and adds
/// nothing.
struct LightWave {
  double hertz = 0;
  double depth = 0;  ///< of a sine, its amplitude; of pulses, the share of the light that goes out
  std::optional<double> duty = {};  ///< the share of a period that pulses last; none: it is a sine

  bool operator==(const LightWave&) const = default;
};

/// Its mean over `length_s` from a time on, in closed form; at time 0 a sine rises and a pulse begins.
double mean_light(const LightWave& wave, double from_s, double length_s);

/// What each of so many rows gets of it in an exposure: a shutter's slit comes to one row after another.
std::vector<double> light_by_row(const LightWave& wave, const CameraExposure& exposure, int rows);

}  // namespace weft::virtual_rig
