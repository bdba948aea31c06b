// SPDX-License-Identifier: Apache-2.0
#include "bench/accuracy/accuracy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "bench/accuracy/score.h"
#include "bench/base/bound.h"
#include "bench/base/solved_maps.h"
#include "simulator/camera/sensor.h"
#include "simulator/scene/rig.h"

namespace weft::bench {
namespace {

constexpr Size kTrials = {256, 256};
constexpr int kGreen = 1;

// One albedo and tilt: every pixel is a trial, with an azimuth of its own.
struct Trials {
  double albedo = 0, tilt_deg = 0;
  std::vector<LightField::Light> lights;
  std::optional<LightField> field;
  NoiseModel noise;
  Image<float> readings;

  // A turn of the golden angle a pixel: all azimuths, and no pattern.
  Vec3 normal(int x, int y) const {
    const double azimuth = kPi * (3 - std::sqrt(5.0)) * (y * kTrials.width + x);
    const double tilt = radians(tilt_deg);
    return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
  }
};

Result<Trials> make_trials(double albedo, double tilt_deg, std::uint32_t seed) {
  const simulator::Scene scene;
  const Result<simulator::SceneRig> rig = simulator::rig_of(scene);
  if (!rig) return rig.error();
  Trials trials;
  trials.albedo = albedo;
  trials.tilt_deg = tilt_deg;
  const Result<LightField> near = LightField::make(rig->leds, rig->camera, rig->camera.size, 0);
  if (!near) return near.error();
  DistantLights here;
  for (std::size_t k = 0; k < near->count(); ++k) {
    const LightField::Light light =
        near->at(k, kGreen, rig->camera.size.width / 2, rig->camera.size.height / 2);
    here.lights.push_back({light.direction, {light.strength, light.strength, light.strength}});
    trials.lights.push_back(light);
  }
  Result<LightField> field = LightField::make(here, std::nullopt, kTrials, 0);
  if (!field) return std::move(field).error();
  trials.field = std::move(*field);

  const double exposure = rig->exposure(scene.camera.iso), electrons = rig->sensor.electrons_at_white;
  const double read = rig->sensor.read_noise_electrons / (electrons * exposure);
  trials.noise = {1 / (electrons * exposure), read * read, 0};
  trials.readings = Image<float>(kTrials, static_cast<int>(trials.lights.size()));
  for (std::size_t k = 0; k < trials.lights.size(); ++k) {
    const LightField::Light& light = trials.lights[k];
    for (int y = 0; y < kTrials.height; ++y) {
      for (int x = 0; x < kTrials.width; ++x) {
        const double cosine = dot(trials.normal(x, y), light.direction);
        float& reading = trials.readings(x, y, static_cast<int>(k));
        reading = -std::numeric_limits<float>::infinity();
        if (cosine <= 0) continue;
        const auto bits = simulator::philox(
            {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(k), 0},
            {seed, 0});
        const double signal = albedo * light.strength * cosine * exposure;
        reading = static_cast<float>(simulator::noisy(rig->sensor, signal, bits) / exposure);
      }
    }
  }
  return trials;
}

Result<Json> row_of(const solver::MethodName& name, const Trials& trials, int threads) {
  SolvedMaps maps(kTrials);
  const Result<void> solved =
      solve_images(*name.make(), planes_of(trials.readings), *trials.field, {}, trials.noise, threads, maps);
  if (!solved) return solved.error();
  constexpr double kChiSquare68 = 2.28;
  double square = 0, bound_square = 0, within = 0, albedo_error = 0;
  std::vector<LightField::Light> facing;
  for (int y = 0; y < kTrials.height; ++y) {
    for (int x = 0; x < kTrials.width; ++x) {
      const Vec3 normal = trials.normal(x, y), estimate = maps.normal_at(x, y);
      facing.clear();
      for (const LightField::Light& light : trials.lights) {
        if (dot(normal, light.direction) > 0) facing.push_back(light);
      }
      const TangentCovariance bound = cramer_rao(facing, normal, trials.albedo, trials.noise);
      square += std::pow(angle_deg(estimate, normal), 2);
      bound_square += std::pow(bound.rms_deg(), 2);
      const double claimed = static_cast<double>(maps.sigma_normal_deg(x, y));
      within += bound.chi_square(estimate, claimed) < kChiSquare68 ? 1 : 0;
      albedo_error += static_cast<double>(maps.albedo(x, y)) - trials.albedo;
    }
  }
  const auto pixels = static_cast<double>(kTrials.pixels());
  return Json{{"method", name.name},
              {"albedo", trials.albedo},
              {"tilt_deg", trials.tilt_deg},
              {"pixels", kTrials.pixels()},
              {"rms_deg", std::sqrt(square / pixels)},
              {"bound_deg", std::sqrt(bound_square / pixels)},
              {"ratio_to_bound", std::sqrt(square / bound_square)},
              {"within_68", within / pixels},
              {"albedo_bias_rel", albedo_error / pixels / trials.albedo}};
}

}  // namespace

/// Scatter of one green photosite at the table's centre under photon and read noise alone, at the exposure
/// for white: albedo 0.04, 0.2 and 0.9, tilted by 0, 20 and 45 degrees to all sides. LEDs that the surface
/// does not face are marked as shadowed for every method. A row for each case and method:
/// ratio_to_bound: rms angle over that of the Cramer-Rao bound.
/// within_68: share of pixels with chi-square below 2.28, the 68 percent point for two degrees of freedom.
/// Methods state an rms angle and no directions, so chi-square takes its size from the method's own sigma and
/// its shape from the bound's tangent covariance, which weighted least squares attains.
Result<Rows> accuracy_bound(const AccuracyTableOptions& options) {
  std::vector<solver::MethodName> methods;
  std::vector<std::string> names;
  for (const solver::MethodName& name : solver::method_names()) {
    if (name.make()->wants_rgb()) continue;
    names.emplace_back(name.name);
    if (options.methods.empty() ||
        std::find(options.methods.begin(), options.methods.end(), name.name) != options.methods.end()) {
      methods.push_back(name);
    }
  }
  for (const std::string& asked : options.methods) {
    if (std::find(names.begin(), names.end(), asked) == names.end()) return no_such("method", asked, names);
  }
  Rows rows;
  std::uint32_t seed = 0;
  for (const double albedo : {0.04, 0.2, 0.9}) {
    for (const double tilt_deg : {0.0, 20.0, 45.0}) {
      const Result<Trials> trials = make_trials(albedo, tilt_deg, ++seed);
      if (!trials) return trials.error();
      for (const solver::MethodName& method : methods) {
        Result<Json> row = row_of(method, *trials, options.threads);
        if (!row) return std::move(row).error();
        rows.push_back(std::move(*row));
      }
    }
  }
  return rows;
}

}  // namespace weft::bench
