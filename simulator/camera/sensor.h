// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "core/rig/calibration.h"
#include "simulator/camera/camera_settings.h"
#include "simulator/sampling/random.h"

namespace weft::simulator {

/// How a body turns light into counts: count = black + (white - black) * signal, where a signal of 1 is full
/// scale.
struct Sensor {
  std::string make;
  std::string model;
  double black = 0;  ///< counts
  double white = 0;  ///< counts
  double electrons_at_white = 0;
  double read_noise_electrons = 0;

  double electrons_per_count() const { return electrons_at_white / (white - black); }
};

Sensor sensor_of(const CameraSettings& camera);

/// The signal with the photons' Poisson noise and the normal noise of reading it out.
inline double noisy(const Sensor& sensor, double signal, std::array<std::uint32_t, 4> random_bits) {
  const NormalPair normal = normal_pair(random_bits);
  const double electrons = poisson(signal * sensor.electrons_at_white, normal.first);
  return (electrons + sensor.read_noise_electrons * normal.second) / sensor.electrons_at_white;
}

/// The nearest whole count inside [0, white].
std::uint16_t count_of(const Sensor& sensor, double signal);

/// What a perfect measurement of this sensor would find. Rounding to whole counts is part of its read noise.
Response response_of(const Sensor& sensor);

}  // namespace weft::simulator
