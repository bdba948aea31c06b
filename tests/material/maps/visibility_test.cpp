// SPDX-License-Identifier: Apache-2.0
#include "material/maps/visibility.h"

#include <gtest/gtest.h>

#include <cmath>

#include "material/maps/cavity.h"
#include "material/maps/specular_occlusion.h"

namespace weft::material {
namespace {

TEST(Visibility, HasTheValuesOfEquations45To49) {
  const double a = 0.6, rho = 0.5;
  EXPECT_DOUBLE_EQ(lit_share(a, rho, HiddenLight::kNone), 0.6);
  EXPECT_DOUBLE_EQ(lit_share(a, rho, HiddenLight::kWhite), 0.84);
  EXPECT_DOUBLE_EQ(lit_share(a, rho, HiddenLight::kSameOpen), 0.8);
  EXPECT_DOUBLE_EQ(lit_share(a, rho, HiddenLight::kSameHidden), 0.72);
  EXPECT_DOUBLE_EQ(lit_share(a, rho), 0.75);
  EXPECT_DOUBLE_EQ(shaded_radiance(a, rho, 2), 0.75 / kPi);
}

// In a hemispherical pit, half open everywhere, every point sees the sky and points as bright as itself: the
// sum of all bounces is equation 49 exactly.
TEST(Visibility, Equation49IsTheSumOfAllBouncesInAPit) {
  for (const double rho : {0.0, 0.2, 0.5, 0.9, 0.999}) {
    double sum = 0, bounce = 0.5;
    for (int i = 0; i < 100; ++i, bounce *= rho * 0.5) sum += bounce;
    EXPECT_NEAR(lit_share(0.5, rho), sum, 1e-12) << rho;
  }
}

TEST(Visibility, HasLimitsAndNeverANaN) {
  EXPECT_EQ(lit_share(0, 0.5), 0);
  EXPECT_EQ(lit_share(0.001, 1), 1);
  EXPECT_EQ(lit_share(0, 1), 0);
  EXPECT_EQ(lit_share(1, 0.3), 1);
  EXPECT_EQ(lit_share(2, -1), 1);
}

TEST(Visibility, ConeSeesAsMuchAsThePoint) {
  for (const double v : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    const double t = radians(cone_angle_deg(v));
    EXPECT_NEAR(std::sin(t) * std::sin(t), v, 1e-12);  // eq. 54
    EXPECT_NEAR(cone_cosine(v), std::cos(t), 1e-8);
  }
  EXPECT_EQ(cone_angle_deg(1), 90);
}

TEST(Visibility, ConesHaveAnEdge) {
  EXPECT_EQ(lit_by_hard_cone(0.75, 0.51), 1);
  EXPECT_EQ(lit_by_hard_cone(0.75, 0.49), 0);
  EXPECT_EQ(lit_by_soft_cone(0.75, 0.5), 1);
  EXPECT_DOUBLE_EQ(lit_by_soft_cone(0.75, 0.25), 0.25);
  EXPECT_EQ(lit_by_soft_cone(0.75, -0.2), 0);
  EXPECT_EQ(lit_by_soft_cone(1, 0.01), 1);
  // Listing 3 at gloss = n.v = 0.5 leaves 0.84 of the cone (0.93 before the gloss is scaled by 1.5).
  EXPECT_NEAR(shipped_cone_cosine(1, 0.5, 0.5), (1 - std::pow(0.75, 8)) * (1 - std::pow(0.5, 4)), 1e-12);
  EXPECT_EQ(shipped_cone_cosine(1, 0.7, 0.5), 0);
}

const SpecularOcclusion& table() {
  static const SpecularOcclusion made;
  return made;
}

/// The lobe within the cone over the lobe within the hemisphere, by a fine grid of directions about the bent
/// normal.
double integrated(double cone_deg, double alpha, double angle_deg) {
  constexpr int kSteps = 400, kTurns = 256;
  const auto lobe = [alpha](double angle) {
    if (angle >= kPi / 2) return 0.0;
    const double c = std::cos(angle / 2), d = c * c * (alpha * alpha - 1) + 1;
    return alpha * alpha / (d * d);
  };
  double inside = 0, all = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double polar = kPi / 2 * (i + 0.5) / kSteps;
    double ring = 0;
    for (int k = 0; k < kTurns; ++k) {
      const double turn = kPi * (k + 0.5) / kTurns, to = radians(angle_deg);
      ring +=
          lobe(std::acos(std::cos(polar) * std::cos(to) + std::sin(polar) * std::sin(to) * std::cos(turn)));
    }
    ring *= std::sin(polar);
    all += ring;
    if (polar < radians(cone_deg)) inside += ring;
  }
  return inside / all;
}

TEST(SpecularOcclusion, IsTheShareOfTheLobeInTheCone) {
  constexpr double kNode_deg = 90.0 / 32;
  for (const int cone : {4, 12, 20, 28}) {
    for (const int rough : {2, 5, 10, 16}) {
      for (const int angle : {0, 9, 18, 27, 32}) {
        const double alpha = rough / 16.0;
        EXPECT_NEAR(table().at(cone * kNode_deg, alpha, angle * kNode_deg),
                    integrated(cone * kNode_deg, alpha, angle * kNode_deg), 0.012)
            << cone * kNode_deg << " degrees, alpha " << alpha << ", " << angle * kNode_deg
            << " degrees apart";
      }
    }
  }
}

TEST(SpecularOcclusion, OfAnOpenPointTakesNothingAndOfAClosedOneAll) {
  for (double alpha = 0; alpha <= 1; alpha += 0.05) {
    for (double angle = 0; angle <= 90; angle += 3.3) {
      EXPECT_NEAR(table().at(90, alpha, angle), 1, 1e-6) << alpha << ", " << angle;
      EXPECT_EQ(table().at(0, alpha, angle), 0) << alpha << ", " << angle;
      double before = 0;
      for (double cone = 0; cone <= 90; cone += 4) {
        const double here = table().at(cone, alpha, angle);
        EXPECT_GE(here, before - 1e-9);
        before = here;
      }
    }
  }
  EXPECT_GT(table().at(30, 0.05, 10), 0.94);
  EXPECT_LT(table().at(30, 0.05, 50), 0.05);
}

Image<float> waves(Size size) {
  Image<float> height(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      height(x, y) = static_cast<float>(0.1 * std::sin(2 * kPi * x / 20) + 0.02 * x);
    }
  }
  return height;
}

TEST(Cavity, IsOneHalfWhereItIsFlatAndFollowsItsFormula) {
  const Size size = {400, 120};
  const Image<float> height = waves(size);
  const auto found = cavity(height.plane(), {.mm_per_pixel = 0.05, .radius_mm = 1, .range_mm = 0.2});
  ASSERT_TRUE(found);
  // A Gaussian of 10 pixels leaves exp(-2 pi^2 (10 / 20)^2) of a wave of 20, and all of a slope.
  const double kept = 1 - std::exp(-2 * kPi * kPi * 0.25);
  for (int x = 100; x < 300; ++x) {
    const double stands_out = 0.1 * kept * std::sin(2 * kPi * x / 20);
    ASSERT_NEAR(found->cavity(x, 60), 0.5 + stands_out / 0.4, 0.003) << x;
  }
  const Image<float> level(size);
  const auto flat = cavity(level.plane(), {.mm_per_pixel = 0.05});
  ASSERT_TRUE(flat);
  EXPECT_EQ(flat->cavity(17, 3), 0.5f);
}

TEST(Cavity, OfATileHasNoSeam) {
  const Size size = {80, 40};
  Image<float> height(size), shifted(size);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 80; ++x) {
      height(x, y) = static_cast<float>(0.1 * std::sin(2 * kPi * x / 80) * std::cos(2 * kPi * y / 40));
      shifted((x + 33) % 80, (y + 11) % 40) = height(x, y);
    }
  }
  for (const double radius_mm : {0.3, 1.5}) {
    const CavityOptions options = {.mm_per_pixel = 0.05, .radius_mm = radius_mm, .is_tile = true};
    const auto a = cavity(height.plane(), options), b = cavity(shifted.plane(), options);
    ASSERT_TRUE(a && b);
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 80; ++x) {
        ASSERT_NEAR(a->cavity(x, y), b->cavity((x + 33) % 80, (y + 11) % 40), 0.004) << radius_mm;
      }
    }
  }
}

TEST(Cavity, RefusesWhatCannotBeMeantAndTakesNoHarmFromNaN) {
  Image<float> height = waves({40, 30});
  height(20, 15) = std::nanf("");
  const auto found = cavity(height.plane(), {.mm_per_pixel = 0.05});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cavity(20, 15), 0.5f);
  EXPECT_GT(found->range_mm, 0);
  for (int x = 0; x < 40; ++x) EXPECT_TRUE(found->cavity(x, 15) >= 0 && found->cavity(x, 15) <= 1);
  EXPECT_FALSE(cavity(height.plane(), {}));
  EXPECT_FALSE(cavity(height.plane(), {.mm_per_pixel = 1, .radius_mm = 0.5}));
  EXPECT_FALSE(cavity({}, {.mm_per_pixel = 1}));
}

}  // namespace
}  // namespace weft::material
