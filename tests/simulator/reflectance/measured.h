// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "simulator/reflectance/reflectance.h"
#include "simulator/sampling/random.h"

// What the tests measure of a reflectance model, without looking into it.

namespace weft::simulator {

inline constexpr Rgb kWhite = {1, 1, 1}, kBlack = {0, 0, 0};

inline Vec3 at_angles(double zenith_deg, double azimuth_deg = 0) {
  const double zenith = radians(zenith_deg), azimuth = radians(azimuth_deg);
  return {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)};
}

/// The mean of body(u1, u2) over the middles of cells of the unit square.
template <typename Body>
double mean_over_square(int cells, const Body& body) {
  double sum = 0;
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) sum += body((i + 0.5) / cells, (j + 0.5) / cells);
  }
  return sum / (cells * cells);
}

/// The integral of body(direction) over the upper hemisphere, by the midpoint rule in zenith angle and
/// azimuth.
template <typename Body>
double integral_over_hemisphere(int cells, const Body& body) {
  return mean_over_square(cells, [&](double u1, double u2) {
    const double zenith = u1 * kPi / 2;
    return kPi * kPi * std::sin(zenith) * body(from_cosine(std::cos(zenith), u2));
  });
}

/// What the model reflects to a view of light of radiance 1 from everywhere: the integral of f (n.l). Narrow
/// lobes are met by quadrature in the model's own sample(); `cells` is even, to part the halves of its
/// mixture.
inline double directional_albedo(const Reflectance& model, const Rgb& albedo, Vec3 view, int cells = 200) {
  const bool narrow = std::holds_alternative<Ggx>(model) || std::holds_alternative<AnisotropicGgx>(model) ||
                      std::holds_alternative<Beckmann>(model) || std::holds_alternative<BlinnPhong>(model);
  if (!narrow) {
    return integral_over_hemisphere(cells, [&](Vec3 l) { return evaluate(model, albedo, l, view)[1] * l.z; });
  }
  return mean_over_square(cells, [&](double u1, double u2) {
    const DirectionSample s = sample(model, view, u1, u2);
    if (!(s.to_light.z > 0)) return 0.0;
    return evaluate(model, albedo, s.to_light, view)[1] * s.to_light.z / s.density;
  });
}

struct NamedModel {
  std::string name;
  Reflectance model;
};

/// Every model in the middle and at the ends of its parameters.
inline const std::vector<NamedModel>& models() {
  static const std::vector<NamedModel> all = [] {
    constexpr Rgb kFibre = {0.04, 0.05, 0.06};
    std::vector<NamedModel> list = {{"Lambert", Lambert()}};
    for (const double x : {0.0, 0.5, 1.0}) {
      const std::string at = " " + std::to_string(x).substr(0, 3);
      list.push_back({"Oren-Nayar" + at, OrenNayar{x * kPi / 2}});
      list.push_back({"Disney" + at, DisneyDiffuse{x}});
      list.push_back({"multiple scattering" + at, MultipleScattering{x}});
      list.push_back({"GGX over Lambert" + at, Ggx{x, kFibre, Beneath::kLambert}});
      list.push_back({"GGX balanced" + at, Ggx{x, kFibre, Beneath::kBalanced}});
      list.push_back({"GGX coupled" + at, Ggx{x, kFibre, Beneath::kCoupled}});
      list.push_back({"anisotropic GGX 0.5" + at, AnisotropicGgx{0.5, x, kFibre, Beneath::kBalanced}});
      list.push_back({"anisotropic GGX 1.0" + at, AnisotropicGgx{1, x, kFibre, Beneath::kBalanced}});
      list.push_back({"Beckmann" + at, Beckmann{x, kFibre, Beneath::kBalanced}});
      list.push_back({"Blinn-Phong" + at, BlinnPhong{x, kFibre, Beneath::kLambert}});
      list.push_back({"cloth" + at, Cloth{x, 4, kFibre}});
      list.push_back({"fibres" + at, FibreCones{3 + 40 * x, 5 - 10 * x, 80 * x, kFibre}});
      list.push_back({"mixed GGX" + at, MixedGgx{0.3, 1 - x, x, kFibre}});
    }
    return list;
  }();
  return all;
}

/// Uniform numbers in (0, 1), always the same ones.
class Uniform {
 public:
  explicit Uniform(std::uint32_t stream) : stream_(stream) {}
  double operator()() {
    const auto bits = philox({count_++, 0, 0, 0}, {stream_, 0});
    return uniform(bits[0], bits[1]);
  }
  Vec3 direction_above() {
    const double cosine = (*this)();
    return from_cosine(cosine, (*this)());
  }

 private:
  std::uint32_t stream_, count_ = 0;
};

}  // namespace weft::simulator
