// SPDX-License-Identifier: Apache-2.0
#include "solver/light_plan/planned_rig.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/base/statistics.h"

namespace weft::solver {
namespace {

using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// What one unit of a parameter does to strength and direction of its LED.
struct Effect {
  std::size_t parameter = 0;  // of the covariance
  std::array<double, kLedErrors> moves = {};
};

std::array<double, 3> parts(Vec3 v) {
  return {v.x, v.y, v.z};
}

// Effects of the parameters of a LED that the covariance names (core/rig/lights.h).
std::vector<Effect> effects_on(const NearLight& led, std::size_t number, Vec3 middle,
                               const std::vector<std::string>& names) {
  std::vector<Effect> effects;
  const auto add = [&](const char* name, double log_strength, double first, double second) {
    const auto at = std::ranges::find(names, fmt::format("led{:02}.{}", number, name));
    if (at != names.end())
      effects.push_back({static_cast<std::size_t>(at - names.begin()), {log_strength, first, second}});
  };
  const Vec3 v = led.position_mm - middle;
  const double distance = length(v);
  const auto by_place = parts((led.mu / dot(v, led.aim)) * led.aim - ((led.mu + 2) / dot(v, v)) * v);
  const auto by_aim = parts(led.mu * ((1 / dot(v, led.aim)) * v - led.aim));
  const auto [first, second] = turns(v);
  const auto along_first = parts((1 / distance) * first), along_second = parts((1 / distance) * second);
  for (std::size_t i = 0; i < 3; ++i) {
    const char axis = "xyz"[i];
    add(fmt::format("position_mm.{}", axis).c_str(), by_place[i], along_first[i], along_second[i]);
    add(fmt::format("aim.{}", axis).c_str(), by_aim[i], 0, 0);
  }
  add("mu", std::log(-dot(v, led.aim) / distance), 0, 0);
  add("log_flux", 1, 0, 0);
  add("log_gain_quadratic.0", 1, 0, 0);
  return effects;
}

ByRows with_floor(ByRows covariance) {
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    const double least = i % static_cast<Eigen::Index>(kLedErrors) == 0 ? kLeastGain : kLeastTurn;
    covariance(i, i) += least * least;
  }
  return covariance;
}

std::vector<double> values_of(const ByRows& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

// Directions of the camera's axis, of azimuth 0 and of azimuth 90 degrees.
std::array<Vec3, 3> axes_of(const ForeseenRig& rig) {
  const Vec3 up = normalized(rig.camera_mm - rig.places_mm.front());
  const Vec3 aside = std::abs(up.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 x = normalized(aside - dot(aside, up) * up);
  return {up, x, cross(up, x)};
}

}  // namespace

std::array<Vec3, 2> turns(Vec3 to_led) {
  const Vec3 l = normalized(to_led);
  const Vec3 first = normalized(cross(std::abs(l.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}, l));
  return {first, cross(l, first)};
}

std::vector<double> typical_led_covariance(const std::vector<NearLight>& leds, Vec3 middle_mm) {
  const auto n = static_cast<Eigen::Index>(kLedErrors * leds.size());
  ByRows covariance = ByRows::Zero(n, n);
  for (std::size_t k = 0; k < leds.size(); ++k) {
    const double turn = kTypicalPosition_mm / length(leds[k].position_mm - middle_mm);
    const auto at = static_cast<Eigen::Index>(kLedErrors * k);
    covariance(at, at) = kTypicalGain * kTypicalGain;
    covariance(at + 1, at + 1) = covariance(at + 2, at + 2) = turn * turn;
  }
  return values_of(covariance);
}

Result<std::vector<double>> led_covariance_of(const std::vector<NearLight>& leds, Vec3 middle_mm,
                                              const ParameterCovariance& covariance) {
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  const auto errors = static_cast<Eigen::Index>(kLedErrors * leds.size());
  const auto bad = [](const char* why) {
    return Error{ErrorKind::kBadData, "covariance of the lights cannot be used", "lights.json", why,
                 "calibrate the lights again, or take \"covariance\" out of lights.json"};
  };
  if (n * n != static_cast<Eigen::Index>(covariance.matrix.size())) return bad("it is not square");
  const Eigen::Map<const ByRows> of_parameters(covariance.matrix.data(), n, n);
  const std::vector<double> typical = typical_led_covariance(leds, middle_mm);
  ByRows effect = ByRows::Zero(errors, n), unnamed = ByRows::Zero(errors, errors);
  for (std::size_t k = 0; k < leds.size(); ++k) {
    const auto first = static_cast<Eigen::Index>(kLedErrors * k);
    const std::vector<Effect> effects = effects_on(leds[k], k + 1, middle_mm, covariance.parameters);
    for (Eigen::Index i = first; i < first + static_cast<Eigen::Index>(kLedErrors); ++i) {
      if (effects.empty()) unnamed(i, i) = typical[static_cast<std::size_t>(i * errors + i)];
      for (const Effect& each : effects)
        effect(i, static_cast<Eigen::Index>(each.parameter)) =
            each.moves[static_cast<std::size_t>(i - first)];
    }
  }
  const ByRows all = with_floor(effect * of_parameters * effect.transpose() + unnamed);
  if (!all.allFinite() || Eigen::LLT<Eigen::MatrixXd>(all).info() != Eigen::Success)
    return bad("a LED would be known better than exactly");
  return values_of(all);
}

LedPlace place_of(const ForeseenRig& rig, Vec3 position_mm) {
  const auto [up, x, y] = axes_of(rig);
  const Vec3 l = position_mm - rig.places_mm.front();
  double azimuth = degrees(std::atan2(dot(l, y), dot(l, x)));
  if (azimuth < 0) azimuth += 360;
  return {angle_deg(l, up), azimuth};
}

NearLight led_at(const ForeseenRig& rig, LedPlace place) {
  const Vec3 middle = rig.places_mm.front();
  std::vector<double> distances, mus, fluxes;
  for (const NearLight& led : rig.leds) {
    distances.push_back(length(led.position_mm - middle));
    mus.push_back(led.mu);
    fluxes.push_back(led.flux_rgb[1]);
  }
  const auto [up, x, y] = axes_of(rig);
  const double tilt = radians(place.from_camera_deg), azimuth = radians(place.azimuth_deg);
  const Vec3 l = std::cos(tilt) * up + std::sin(tilt) * (std::cos(azimuth) * x + std::sin(azimuth) * y);
  NearLight led;
  led.position_mm = middle + median(distances) * l;
  led.aim = -1.0 * l;
  led.mu = median(mus);
  led.flux_rgb.fill(median(fluxes));
  return led;
}

}  // namespace weft::solver
