// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "bench/accuracy/accuracy.h"
#include "bench/base/bound.h"
#include "simulator/camera/sensor.h"
#include "simulator/scene/rig.h"

namespace weft::bench {
namespace {

constexpr double kAlbedo = 0.5, kTilt_deg = 20;
constexpr int kSides = 12;

std::vector<Vec3> test_normals() {
  std::vector<Vec3> normals = {{0, 0, 1}};
  for (int i = 0; i < kSides; ++i) {
    const double azimuth = 2 * kPi * i / kSides, tilt = radians(kTilt_deg);
    normals.push_back(
        {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)});
  }
  return normals;
}

// Sum over the normals of the square of the bound.
double badness(std::span<const LightField::Light> lights, const std::vector<Vec3>& normals,
               const NoiseModel& noise) {
  double sum = 0;
  for (const Vec3 normal : normals) {
    std::vector<LightField::Light> facing;
    for (const LightField::Light& light : lights) {
      if (dot(light.direction, normal) > 0) facing.push_back(light);
    }
    sum += std::pow(cramer_rao(facing, normal, kAlbedo, noise).rms_deg(), 2);
  }
  return sum;
}

}  // namespace

Result<std::vector<int>> leds_by_bound(int count) {
  const simulator::Scene scene;
  const Result<simulator::SceneRig> rig = simulator::rig_of(scene);
  if (!rig) return rig.error();
  const double full = rig->exposure(scene.camera.iso) * rig->sensor.electrons_at_white;
  const NoiseModel noise = {1 / full, std::pow(rig->sensor.read_noise_electrons / full, 2), 0};
  std::vector<LightField::Light> lights;
  for (const DistantLight& light : simulator::distant_lights(*rig, 0).lights) {
    lights.push_back({light.direction, light.irradiance_rgb[1]});
  }
  const std::vector<Vec3> normals = test_normals();
  std::vector<int> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t mask = 0; mask < 1U << lights.size(); ++mask) {
    std::vector<int> numbers;
    std::vector<LightField::Light> chosen;
    for (std::size_t k = 0; k < lights.size(); ++k) {
      if ((mask >> k & 1U) == 0) continue;
      numbers.push_back(static_cast<int>(k) + 1);
      chosen.push_back(lights[k]);
    }
    if (static_cast<int>(numbers.size()) != count) continue;
    if (const double sum = badness(chosen, normals, noise); sum < least) {
      least = sum;
      best = numbers;
    }
  }
  return best;
}

}  // namespace weft::bench
