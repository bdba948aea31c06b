// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/hard_lights.h"

#include <cmath>
#include <map>

namespace weft::test {
namespace {

Vec3 as_float(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// `spread` is the tangent of the angle between a light and the axis.
DistantLights lights_around_axis(std::size_t count, double spread) {
  const Vec3 axis = cluster_axis(), across = {0, 1, 0}, up = cross(axis, across);
  DistantLights lights;
  for (std::size_t k = 0; k < count; ++k) {
    const double azimuth = 2 * kPi * (static_cast<double>(k) + 0.3) / static_cast<double>(count);
    lights.lights.push_back(
        {as_float(normalized(axis + spread * std::cos(azimuth) * across + spread * std::sin(azimuth) * up)),
         {1, 1, 1}});
  }
  return lights;
}

double condition_of(const DistantLights& lights) {
  std::vector<Vec3> directions;
  for (const DistantLight& light : lights.lights) directions.push_back(light.direction);
  return condition_number(directions);
}

}  // namespace

Vec3 cluster_axis() {
  return {std::sin(radians(20)), 0, std::cos(radians(20))};
}

DistantLights clustered_lights(std::size_t count, double condition) {
  double wide = std::sqrt(2.0), close = 1e-8;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(wide * close);
    (condition_of(lights_around_axis(count, middle)) < condition ? wide : close) = middle;
  }
  return lights_around_axis(count, wide);
}

LightField coplanar_field(double condition_beside) {
  // In (along, across) of a plane that rises by 60 degrees from the line x = 0.
  constexpr std::array<std::array<double, 2>, 6> kPlaces = {
      {{400, 0}, {600, -300}, {600, 300}, {500, -150}, {700, 100}, {450, 250}}};
  NearLights lights;
  for (const auto& [up_mm, y_mm] : kPlaces) {
    NearLight led;
    led.position_mm = {-up_mm * std::cos(radians(60)), y_mm, up_mm * std::sin(radians(60))};
    led.aim = (-1 / length(led.position_mm)) * led.position_mm;
    led.flux_rgb = {3e5, 3e5, 3e5};
    lights.leds.push_back(led);
  }
  // Measured at 1 mm: the condition number of this arrangement goes with the inverse of the distance.
  constexpr double kConditionAt1mm = 6000;
  const double mm_per_pixel = kConditionAt1mm / condition_beside;
  const double centre = (kLineFrame.width - 1) / 2.0, middle = (kLineFrame.height - 1) / 2.0;
  for (NearLight& led : lights.leds) led.position_mm.x += (kLinePixel - centre) * mm_per_pixel;
  for (NearLight& led : lights.leds) led.position_mm.y += middle * mm_per_pixel;
  return *LightField::make(lights, overhead_camera(kLineFrame, 600, mm_per_pixel), kLineFrame, 0);
}

void for_each_method(
    const std::function<void(const solver::Method& method, const std::string& name, int planes)>& check) {
  for (const solver::MethodName& name : solver::method_names()) {
    const std::unique_ptr<solver::Method> method = name.make();
    for (const int planes : {1, 3}) {
      if (planes == 3 || !method->wants_rgb()) check(*method, name.name, planes);
    }
  }
}

Promise promise_of(const std::string& method) {
  static const std::map<std::string, Promise> kPromises = {
      {"fast", {.one_weight = true, .masks_shadow = true}},
      {"standard", {.masks_shadow = true}},
      {"robust", {.masks_shadow = true}},
      {"wls", {.masks_shadow = true}},
      {"lts", {.masks_shadow = true}},
      {"seed", {.one_weight = true}},
      {"least-squares", {.one_weight = true}}};
  const auto found = kPromises.find(method);
  return found == kPromises.end() ? Promise() : found->second;
}

}  // namespace weft::test
