// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/lobe.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "simulator/reflectance/reflectance.h"
#include "tests/solver/reflectance/pixels.h"

namespace weft::solver {
namespace {

const std::array<Lobe, 7> kLobes = {
    Lobe{.family = LobeFamily::kLambert, .bend = 0.2},
    Lobe{.family = LobeFamily::kGgx, .alpha = 0.3, .f0 = 0.04},
    Lobe{.family = LobeFamily::kGgx, .alpha = 0.15, .f0 = 0.05, .bend = 0.1},
    Lobe{.family = LobeFamily::kAnisotropicGgx, .alpha = 0.45, .f0 = 0.05, .along = 0.35, .axis = 0.4},
    Lobe{.family = LobeFamily::kBeckmann, .alpha = 0.3, .f0 = 0.04},
    Lobe{.family = LobeFamily::kCloth, .alpha = 0.4, .f0 = 0.05},
    Lobe{.family = LobeFamily::kTwoGgx, .alpha = 0.15, .f0 = 0.05, .broad = 0.5, .broad_share = 0.4}};

TEST(Lobe, DerivativeIsThatOfTheReading) {
  Random random(1);
  for (const Lobe& lobe : kLobes) {
    for (int i = 0; i < 50; ++i) {
      const Vec3 b = (0.05 + 0.5 * random.uniform()) * random_normal(random, 30);
      for (const Vec3& l : ten_directions()) {
        const LitFrom from(l, normalized({0.1, -0.05, 1}));
        if (dot(b, l) < 0.02) continue;
        const ModelledReading m = modelled_with_derivative(lobe, b, from, 0.3);
        EXPECT_NEAR(m.x, modelled(lobe, b, from, 0.3), 1e-12);
        const double h = 1e-6;
        for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
          const double slope =
              (modelled(lobe, b + h * axis, from, 0.3) - modelled(lobe, b - h * axis, from, 0.3)) / (2 * h);
          EXPECT_NEAR(dot(m.by_b, axis), slope, 1e-3 * std::max(1.0, std::abs(slope)))
              << name_of(lobe.family);
        }
      }
    }
  }
}

// The simulator's models are other code. Its x runs along the fibres.
TEST(Lobe, IsWhatTheSimulatorReflects) {
  using namespace simulator;
  const auto grey = [](double v) { return Rgb{v, v, v}; };
  struct Pair {
    Lobe lobe;
    Reflectance model;
  };
  const std::array<Pair, 4> pairs = {
      {{{.family = LobeFamily::kGgx, .alpha = 0.3, .f0 = 0.04},
        Ggx{.alpha = 0.3, .f0 = grey(0.04), .beneath = Beneath::kBalanced}},
       {{.family = LobeFamily::kAnisotropicGgx, .alpha = 0.45, .f0 = 0.05, .along = 0.35},
        AnisotropicGgx{.alpha = 0.45, .anisotropy = 0.65, .f0 = grey(0.05)}},
       {{.family = LobeFamily::kBeckmann, .alpha = 0.3, .f0 = 0.04},
        Beckmann{.alpha = 0.3, .f0 = grey(0.04), .beneath = Beneath::kBalanced}},
       {{.family = LobeFamily::kTwoGgx, .alpha = 0.15, .f0 = 0.05, .broad = 0.5, .broad_share = 0.4},
        MixedGgx{.alpha = 0.15, .second_alpha = 0.5, .second_share = 0.4, .f0 = grey(0.05)}}}};
  for (const Pair& pair : pairs) {
    for (const Vec3& l : ten_directions()) {
      for (const Vec3 v : {Vec3{0, 0, 1}, normalized({0.3, 0.1, 1})}) {
        const double albedo = 0.35;
        const double truth = kPi * simulator::evaluate(pair.model, grey(albedo), l, v)[1] * l.z;
        EXPECT_NEAR(modelled(pair.lobe, {0, 0, albedo}, LitFrom(l, v), 0), truth, 1e-6 + 1e-3 * truth)
            << name_of(pair.lobe.family);
      }
    }
  }
}

TEST(Lobe, IsReciprocal) {
  Random random(2);
  for (const Lobe& lobe : kLobes) {
    for (int i = 0; i < 100; ++i) {
      const Vec3 n = random_normal(random, 20), l = random_normal(random, 50), v = random_normal(random, 50);
      EXPECT_NEAR(specular(lobe, n, LitFrom(l, v), 0.2), specular(lobe, n, LitFrom(v, l), 0.2), 1e-9);
    }
  }
}

}  // namespace
}  // namespace weft::solver
