// SPDX-License-Identifier: Apache-2.0
#include "simulator/camera/sensor.h"

#include <algorithm>
#include <cmath>

namespace weft::simulator {

namespace {

Sensor sensor_of(Body body) {
  switch (body) {
    case Body::kD5100:
      return {"NIKON CORPORATION", "NIKON D5100", 0, 15846};
    case Body::kD80:
      return {"NIKON CORPORATION", "NIKON D80", 0, 15846};
    case Body::kOffset:
      break;
  }
  return {"weft", "virtual camera", 600, 15520};
}

}  // namespace

Sensor sensor_of(const CameraSettings& camera) {
  Sensor sensor = sensor_of(camera.body);
  const double scale = std::ldexp(1.0, camera.bits - 14);  // the levels above are those of 14 bits
  sensor.black = std::floor(sensor.black * scale);
  sensor.white = std::floor(sensor.white * scale);
  sensor.electrons_at_white = camera.full_well_electrons * 100 / camera.iso;
  sensor.read_noise_electrons = camera.read_noise_electrons;
  return sensor;
}

std::uint16_t count_of(const Sensor& sensor, double signal) {
  const double count = std::floor(sensor.black + (sensor.white - sensor.black) * signal + 0.5);
  return static_cast<std::uint16_t>(std::clamp(count, 0.0, sensor.white));
}

Response response_of(const Sensor& sensor) {
  Response response;
  response.electrons_per_count = sensor.electrons_per_count();
  response.read_noise_counts =
      std::hypot(sensor.read_noise_electrons / sensor.electrons_per_count(), std::sqrt(1.0 / 12));
  const double black = sensor.black;
  response.levels = {{black, black, black, black}, sensor.white, {black, black, black}};
  return response;
}

}  // namespace weft::simulator
