// SPDX-License-Identifier: Apache-2.0
#include "simulator/reflectance/reflectance.h"

namespace weft::simulator {
namespace {

template <typename Model>
concept HasLobe = requires(const Model& model, Vec3 v) {
  model.sample(v, 0.0, 0.0);
};

}  // namespace

Rgb evaluate(const Reflectance& model, const Rgb& albedo, Vec3 to_light, Vec3 to_view) {
  return std::visit([&](const auto& m) { return m.evaluate(albedo, to_light, to_view); }, model);
}

DirectionSample sample(const Reflectance& model, Vec3 to_view, double u1, double u2) {
  return std::visit(
      [&]<typename Model>(const Model& m) -> DirectionSample {
        if constexpr (HasLobe<Model>) {
          return m.sample(to_view, u1, u2);
        } else {
          const Vec3 l = cosine_direction(u1, u2);
          return {l, cosine_density(l)};
        }
      },
      model);
}

double density(const Reflectance& model, Vec3 to_light, Vec3 to_view) {
  return std::visit(
      [&]<typename Model>(const Model& m) -> double {
        if constexpr (HasLobe<Model>) {
          return m.density(to_light, to_view);
        } else {
          return cosine_density(to_light);
        }
      },
      model);
}

}  // namespace weft::simulator
