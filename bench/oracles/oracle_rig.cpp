// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/oracle_rig.h"

#include <algorithm>
#include <cmath>

namespace weft::test {

NearLights ten_leds(double mu) {
  NearLights lights;
  const auto add_ring = [&](int count, double zenith_deg, double first_deg) {
    for (int i = 0; i < count; ++i) {
      const double azimuth = radians(first_deg + 360.0 * i / count), zenith = radians(zenith_deg);
      NearLight led;
      led.position_mm = {600 * std::sin(zenith) * std::cos(azimuth),
                         600 * std::sin(zenith) * std::sin(azimuth), 600 * std::cos(zenith)};
      led.aim = -1.0 / 600 * led.position_mm;
      led.mu = mu;
      led.flux_rgb = {1.8e5, 3.6e5, 2.4e5};
      lights.leds.push_back(led);
    }
  };
  add_ring(4, 35, 0);
  add_ring(6, 62, 15);
  return lights;
}

double Random::uniform() {
  std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

double Random::normal() {
  const double u = 1 - uniform();
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * kPi * uniform());
}

Vec3 random_normal(Random& random, double most_deg) {
  const double z = 1 - random.uniform() * (1 - std::cos(radians(most_deg)));
  const double azimuth = 2 * kPi * random.uniform();
  const double s = std::sqrt(1 - z * z);
  return {s * std::cos(azimuth), s * std::sin(azimuth), z};
}

Trial::Trial(const LightField& field, Rect tile, int planes, const std::function<Truth(int, int)>& truth)
    : normals({tile.width(), tile.height()}, 3),
      albedo(normals.size(), 3),
      sigma_albedo(normals.size(), 3),
      sigma_normal_deg(normals.size()),
      residual(normals.size()),
      status(normals.size()),
      field_(&field),
      tile_(tile),
      planes_(planes),
      truth_(truth),
      readings_(normals.size(), static_cast<int>(field.count()) * planes) {
  for (int y = 0; y < tile.height(); ++y) {
    for (int x = 0; x < tile.width(); ++x) {
      const Truth t = truth(x, y);
      for (std::size_t k = 0; k < field.count(); ++k) {
        for (int p = 0; p < planes; ++p) {
          const int c = planes == 1 ? cfa.channel_at(tile.x0 + x, tile.y0 + y) : p;
          const LightField::Light light = field.at(k, c, tile.x0 + x, tile.y0 + y);
          reading(k, p)(x, y) = static_cast<float>(t.albedo[static_cast<std::size_t>(c)] * light.strength *
                                                   std::max(0.0, dot(t.normal, light.direction)));
        }
      }
    }
  }
}

void Trial::add_noise(const NoiseModel& noise, std::uint64_t seed) {
  Random random(seed);
  for (int y = 0; y < tile_.height(); ++y) {
    for (int x = 0; x < tile_.width(); ++x) {
      const double shared = std::sqrt(noise.shared) * random.normal();
      for (int i = 0; i < readings_.planes(); ++i) {
        float& r = readings_(x, y, i);
        r = static_cast<float>(static_cast<double>(r) +
                               std::sqrt(noise.variance(static_cast<double>(r))) * random.normal() - shared);
      }
    }
  }
}

void Trial::solve(const solver::Method& method, const std::optional<NoiseModel>& noise) {
  std::vector<View<const float>> views;
  for (int i = 0; i < readings_.planes(); ++i) views.push_back(readings_.plane(i));
  const solver::TileInput input = {tile_, planes_, cfa, views, field_, noise};
  const solver::TileOutput output = {{normals.plane(0), normals.plane(1), normals.plane(2)},
                                     {albedo.plane(0), albedo.plane(1), albedo.plane(2)},
                                     sigma_normal_deg.plane(),
                                     {sigma_albedo.plane(0), sigma_albedo.plane(1), sigma_albedo.plane(2)},
                                     residual.plane(),
                                     status.plane()};
  method.solve(input, output);
}

Vec3 Trial::normal(int x, int y) const {
  return {normals(x, y, 0), normals(x, y, 1), normals(x, y, 2)};
}

std::vector<solver::PixelRow> Trial::rows(int x, int y) const {
  std::vector<solver::PixelRow> rows(field_->count());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (int p = 0; p < planes_; ++p) {
      const int c = planes_ == 1 ? cfa.channel_at(tile_.x0 + x, tile_.y0 + y) : p;
      const LightField::Light light = field_->at(k, c, tile_.x0 + x, tile_.y0 + y);
      rows[k].direction = light.direction;
      rows[k].strength[static_cast<std::size_t>(p)] = light.strength;
      rows[k].reading[static_cast<std::size_t>(p)] = readings_(x, y, static_cast<int>(k) * planes_ + p);
    }
  }
  return rows;
}

double Trial::error_deg(int x, int y) const {
  return angle_deg(normal(x, y), truth_(x, y).normal);
}

}  // namespace weft::test
