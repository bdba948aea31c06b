// SPDX-License-Identifier: Apache-2.0
// The ends of parameters and angles, where the formulas as printed divide by 0.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/simulator/reflectance/measured.h"

namespace weft::simulator {
namespace {

const std::vector<double> kAzimuths_deg = {0, 90, 180, 217};

/// A direction of a given n.direction, exact down to the smallest numbers.
Vec3 with_cosine(double cosine, double azimuth_deg) {
  const double sine = std::sqrt(1 - cosine * cosine), azimuth = radians(azimuth_deg);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

TEST(Limits, EveryModelIsFiniteInFloat32AndNotNegativeAtEveryAngle) {
  for (const NamedModel& each : models()) {
    for (const double n_l : {1e-300, 1e-30, 1e-9, 0.5, 1.0}) {
      for (const double n_v : {-1.0, -0.5, -1e-9, -1e-30, 0.0, 1e-300, 1e-30, 1e-9, 0.5, 1.0}) {
        for (const double azimuth_deg : kAzimuths_deg) {
          const Rgb f = evaluate(each.model, kWhite, with_cosine(n_l, 0), with_cosine(n_v, azimuth_deg));
          for (const double channel : f) {
            EXPECT_TRUE(std::isfinite(static_cast<float>(channel)) && channel >= 0)
                << each.name << " gives " << channel << " at n.l " << n_l << ", n.v " << n_v << ", azimuth "
                << azimuth_deg;
          }
        }
      }
    }
  }
}

TEST(Limits, LightAtOrBelowTheHorizonGivesNothing) {
  for (const NamedModel& each : models()) {
    for (const double n_l : {0.0, -1e-30, -0.5, -1.0}) {
      EXPECT_EQ(evaluate(each.model, kWhite, with_cosine(n_l, 0), {0, 0, 1}), kBlack) << each.name;
    }
  }
}

TEST(Limits, LightThatSetsFadesWithoutAStep) {
  for (const NamedModel& each : models()) {
    for (const double n_v : {0.0, 0.7}) {
      const double n_l = 1e-12;
      const double shaded = n_l * evaluate(each.model, kWhite, with_cosine(n_l, 0), with_cosine(n_v, 30))[1];
      EXPECT_LT(shaded, 1e-6) << each.name << " seen at n.v " << n_v;
    }
  }
}

TEST(Limits, AViewThatDropsBelowTheHorizonSeesNoStep) {
  for (const NamedModel& each : models()) {
    for (const double azimuth_deg : kAzimuths_deg) {
      const Vec3 l = with_cosine(0.5, 0);
      const double above = evaluate(each.model, kWhite, l, with_cosine(1e-9, azimuth_deg))[1];
      const double on = evaluate(each.model, kWhite, l, with_cosine(0, azimuth_deg))[1];
      const double below = evaluate(each.model, kWhite, l, with_cosine(-1e-9, azimuth_deg))[1];
      EXPECT_NEAR(above / on, 1, 1e-4) << each.name << " at azimuth " << azimuth_deg;
      EXPECT_NEAR(below / on, 1, 1e-4) << each.name << " at azimuth " << azimuth_deg;
    }
  }
}

TEST(Limits, TheTopOfTheHighlightIsSmooth) {
  for (const NamedModel& each : models()) {
    const double top = evaluate(each.model, kWhite, {0, 0, 1}, {0, 0, 1})[1];
    const double beside = evaluate(each.model, kWhite, {0, 0, 1}, {1e-8, 0, 1})[1];
    EXPECT_NEAR(beside / top, 1, 1e-6) << each.name << ", n.h 1";
  }
}

TEST(Limits, ALobeWithoutRoughnessHasTheSmallestOne) {
  const Vec3 l = at_angles(30), v = at_angles(30.05, 180);
  const auto same = [&](const Reflectance& none, const Reflectance& smallest) {
    EXPECT_EQ(evaluate(none, kWhite, l, v), evaluate(smallest, kWhite, l, v));
    EXPECT_GT(evaluate(none, kBlack, l, v)[1], 10) << "a highlight is there";
  };
  same(Ggx{0}, Ggx{kSmallestAlpha});
  same(Beckmann{0}, Beckmann{kSmallestAlpha});
  same(AnisotropicGgx{0, 0}, Ggx{kSmallestAlpha});
  EXPECT_EQ(Cloth{0}.distribution(at_angles(80)), Cloth{kSmallestAlpha}.distribution(at_angles(80)));
}

TEST(Limits, TheSmallestHighlightIs015DegreesWide) {
  const Vec3 v = at_angles(30, 180);
  const double top = evaluate(Ggx{0}, kBlack, at_angles(30), v)[1];
  EXPECT_NEAR(evaluate(Ggx{0}, kBlack, at_angles(30 + 0.074), v)[1] / top, 0.5, 0.01);
}

TEST(Limits, FullAnisotropyHasTheSmallestRoughnessAlongTheFibres) {
  const GgxLobe full = AnisotropicGgx{0.5, 1}.lobe(), expected(kSmallestAlpha, 0.5);
  for (const Vec3 h : {Vec3{0, 0, 1}, at_angles(30, 90), at_angles(30, 0), at_angles(90, 90)}) {
    EXPECT_EQ(full.distribution(h), expected.distribution(h));
  }
}

TEST(Limits, FibresThatStandUprightAreSeenAtTheRimOnly) {
  const Cloth upright = {0, 4};
  EXPECT_NEAR(upright.distribution({0, 0, 1}), 1 / kPi, 1e-5) << "n.h 1: the offset is left";
  EXPECT_NEAR(upright.distribution({1, 0, 0}), 5 / kPi, 1e-4) << "n.h 0: and the fuzz";
  EXPECT_EQ(Cloth({1, 4}).distribution({1, 0, 0}), 1 / kPi) << "alpha 1: (1 + 4) / (1 + 4)";
}

TEST(Limits, BeckmannsFacetsHaveNoneOnEdgeAndItsFitHasNoStep) {
  EXPECT_EQ(Beckmann{1}.distribution({1, 0, 0}), 0) << "n.h 0";
  EXPECT_NEAR(Beckmann{1}.distribution({0, 0, 1}), 1 / kPi, 1e-15) << "n.h 1";
  const Beckmann model = {0.5};
  EXPECT_NEAR(model.shadowing_over_cosine(0), 3.535 / 0.5, 1e-12) << "n.v 0";
  EXPECT_EQ(model.shadowing_over_cosine(1), 1) << "n.v 1";
  double before = model.shadowing_over_cosine(0.61);  // the fit reaches 1 a little below 0.6247, a = 1.6
  for (double c = 0.61; c < 0.64; c += 1e-6) {
    const double now = model.shadowing_over_cosine(c);
    ASSERT_NEAR(now, before, 5e-6) << "n.v " << c;
    before = now;
  }
}

/// The formulas as printed, in the arithmetic of the documents' shaders.
float seed_000_equation_3(float c, float a) {
  return 2 / (1 + std::sqrt(1 + a * a * (1 - c * c) / (c * c)));
}
float seed_000_equation_2(float c, float a) {
  const float root = c * c * (a * a - 1) + 1;
  return a * a / (3.14159265F * root * root);
}
float seed_000_equation_14(float t, float b, float n, float a_t, float a_b) {
  const float sum = (t / a_t) * (t / a_t) + (b / a_b) * (b / a_b) + n * n;
  return 1 / (3.14159265F * a_t * a_b) / (sum * sum);
}
float seed_000_equation_22(float c, float a) {
  const float sin2 = 1 - c * c;
  return 1 / (3.14159265F * (1 + 4 * a * a)) * (1 + 4 * std::exp(-c * c / sin2 / (a * a)) / (sin2 * sin2));
}
float seed_000_beckmann(float c, float a) {
  return std::exp(-(1 - c * c) / (c * c) / (a * a)) / (3.14159265F * a * a * c * c * c * c);
}

TEST(Limits, AreWhereThePrintedFormulasFailInFloat32) {
  EXPECT_TRUE(std::isnan(seed_000_equation_3(0, 0.5F) / (4 * 0.5F * 0.0F))) << "eq. 1 and 3, n.v 0";
  EXPECT_TRUE(std::isnan(seed_000_equation_2(1, 0))) << "eq. 2, alpha 0 and n.h 1";
  EXPECT_TRUE(std::isnan(seed_000_equation_14(0, 0, 1, 0.5F, 0))) << "eq. 14, anisotropy 1";
  EXPECT_TRUE(std::isnan(seed_000_equation_22(1, 0.5F))) << "eq. 22, n.h 1";
  EXPECT_TRUE(std::isnan(seed_000_equation_22(0, 0))) << "eq. 22, alpha 0 and n.h 0";
  EXPECT_TRUE(std::isnan(seed_000_beckmann(0, 0.5F))) << "appendix A, n.h 0";
}

}  // namespace
}  // namespace weft::simulator
