// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/virtual_sensor.h"

#include "simulator/camera/saturation.h"
#include "simulator/sampling/random.h"

namespace weft::test {

VirtualSensor VirtualSensor::of(simulator::Body body) {
  simulator::CameraSettings camera;
  camera.body = body;
  VirtualSensor sensor;
  sensor.sensor = simulator::sensor_of(camera);
  return sensor;
}

RawFrame VirtualSensor::frame(Size size, int take, double exposure_us,
                              const std::function<double(int x, int y, int channel)>& signal) const {
  RawFrame frame;
  frame.counts = Image<std::uint16_t>(size);
  for (auto& row : frame.black) row.fill(static_cast<float>(sensor.black));
  frame.white = static_cast<float>(sensor.white);
  frame.shot = {sensor.make, sensor.model, "virtual", exposure_us, 100, 8, 35};
  const simulator::NonLinearity bend = *simulator::NonLinearity::of(linearity);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto bits = simulator::philox(
          {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(take), 0},
          {seed, 0});
      const double v = simulator::noisy(sensor, signal(x, y, frame.cfa.channel_at(x, y)), bits);
      frame.counts(x, y) = simulator::count_of(sensor, bend.distorted(v));
    }
  }
  return frame;
}

}  // namespace weft::test
