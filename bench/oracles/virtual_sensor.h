// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "simulator/camera/sensor.h"

namespace weft::test {

/// A sensor of the simulator without a scene: signals in, frames of counts out.
struct VirtualSensor {
  simulator::Sensor sensor;
  std::array<double, 2> linearity = {};  ///< of core's Response, all channels alike
  std::uint32_t seed = 1;

  static VirtualSensor of(simulator::Body body);

  /// Photons counted with noise, bent, converted. `signal` of a photosite is 1 at full scale; `take` numbers
  /// the frame, and another take has other noise.
  RawFrame frame(Size size, int take, double exposure_us,
                 const std::function<double(int x, int y, int channel)>& signal) const;
};

}  // namespace weft::test
