// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/simulated_cloth.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "simulator/sampling/random.h"

namespace weft::test {
namespace {

template <typename T>
T unwrapped(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return std::move(*result);
}

}  // namespace

simulator::Scene seen_from_afar(simulator::Scene scene, int width) {
  constexpr int kFewRays = 8;
  const int less = std::max(1, scene.camera.width / width);
  scene.camera.width = scene.camera.width / less / 2 * 2;
  scene.camera.height = scene.camera.height / less / 2 * 2;
  scene.camera.mm_per_pixel *= less;
  scene.transport.bounce_rays = kFewRays;
  return scene;
}

SimulatedCloth::SimulatedCloth(simulator::Scene scene)
    : scene_(std::move(scene)),
      rig_(unwrapped(simulator::rig_of(scene_))),
      rendering_(
          unwrapped(simulator::render_readings(scene_, {0, 0, scene_.camera.width, scene_.camera.height}))),
      calibration_(simulator::exact_calibration(scene_, rig_)) {}

RawFrame SimulatedCloth::photograph(const Lighting& lighting, double exposure_us, std::uint32_t take) const {
  const simulator::Sensor& sensor = rig_.sensor;
  const Size size = {scene_.camera.width, scene_.camera.height};
  RawFrame frame = {Image<std::uint16_t>(size), {}, {}, static_cast<float>(sensor.white), {}};
  for (auto& row : frame.black) row.fill(static_cast<float>(sensor.black));
  frame.shot = {sensor.make,       sensor.model,           calibration_.subject.camera_serial, exposure_us,
                scene_.camera.iso, scene_.camera.f_number, simulator::kFocalLength_mm};
  double unit = 0;  // reading of a white surface under LED 1
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) unit += rendering_.readings(x, y, 1) / rendering_.albedo(x, y, 1);
  }
  unit /= static_cast<double>(size.pixels());
  const double seconds = exposure_us * 1e-6 * scene_.camera.iso / 100;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const int c = frame.cfa.channel_at(x, y);
      const double white_balance = scene_.lights.white_balance[static_cast<std::size_t>(c)];
      double reading = lighting.room * unit * white_balance * rendering_.albedo(x, y, c);
      for (const auto& [led, share] : lighting.leds)
        reading += share * rendering_.readings(x, y, 3 * (led - 1) + c);
      double signal = reading * seconds;
      if (scene_.effects.noise) {
        const auto bits = simulator::philox(
            {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), take, 0}, {20261121, 6});
        signal = simulator::noisy(sensor, signal, bits);
      }
      frame.counts(x, y) = simulator::count_of(sensor, signal);
    }
  }
  return frame;
}

}  // namespace weft::test
