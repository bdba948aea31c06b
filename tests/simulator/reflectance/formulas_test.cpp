// SPDX-License-Identifier: Apache-2.0
// The models against closed forms, independent formulas and the misprints of the documents.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/simulator/reflectance/measured.h"

namespace weft::simulator {
namespace {

double green(const Reflectance& model, const Rgb& albedo, Vec3 l, Vec3 v) {
  return evaluate(model, albedo, l, v)[1];
}

TEST(Lambert, GivesAlbedoTimesStrengthTimesCosine) {
  const Rgb albedo = {0.9, 0.5, 0.04};
  const Vec3 l = at_angles(37, 20);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_DOUBLE_EQ(kPi * evaluate(Lambert(), albedo, l, at_angles(10))[c] * l.z * 3.5,
                     albedo[c] * 3.5 * l.z);
  }
}

TEST(Reflectance, IsReciprocalInEveryModel) {
  Uniform uniform_number(1);
  const Rgb albedo = {0.9, 0.5, 0.04};
  for (const NamedModel& each : models()) {
    for (int i = 0; i < 200; ++i) {
      const Vec3 l = uniform_number.direction_above(), v = uniform_number.direction_above();
      const Rgb there = evaluate(each.model, albedo, l, v), back = evaluate(each.model, albedo, v, l);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(there[c] / back[c], 1, 1e-9) << each.name;
    }
  }
}

TEST(Reflectance, OnlyIsotropicModelsAreTheSameAfterATurn) {
  const auto turned = [](Vec3 d) { return Vec3{-d.y, d.x, d.z}; };
  const Vec3 l = at_angles(50, 5), v = at_angles(40, 160);
  for (const NamedModel& each : models()) {
    const auto* fibres = std::get_if<AnisotropicGgx>(&each.model);
    const bool directed =
        (fibres != nullptr && fibres->anisotropy > 0) || std::holds_alternative<FibreCones>(each.model);
    const Rgb albedo = directed ? kBlack : kWhite;  // the lobe alone
    const double change =
        green(each.model, albedo, turned(l), turned(v)) / green(each.model, albedo, l, v) - 1;
    if (directed) {
      EXPECT_GT(std::abs(change), 0.1) << each.name;
    } else {
      EXPECT_NEAR(change, 0, 1e-9) << each.name;
    }
  }
}

TEST(FacetDistributions, IntegrateToOneAgainstTheCosine) {
  const auto projected = [](const auto& distribution) {
    return integral_over_hemisphere(400, [&](Vec3 h) { return distribution(h) * h.z; });
  };
  for (const double a : {0.1, 0.5, 1.0}) {
    EXPECT_NEAR(projected([&](Vec3 h) { return GgxLobe(a, a).distribution(h); }), 1, 1e-3) << "alpha " << a;
    EXPECT_NEAR(projected([&](Vec3 h) { return GgxLobe(0.3 * a, a).distribution(h); }), 1, 1e-2)
        << "alpha " << a;
    EXPECT_NEAR(projected([&](Vec3 h) { return Beckmann{a}.distribution(h); }), 1, 1e-3) << "alpha " << a;
    EXPECT_NEAR(projected([&](Vec3 h) { return BlinnPhong{a * 0.6}.distribution(h); }), 1, 1e-3)
        << "gloss " << a;
  }
}

TEST(Cloth, DistributionOfEquation22IntegratesToOneAndThatOf21DoesNot) {
  const double of_21[] = {0.9993, 0.85, 0.52};
  int i = 0;
  for (const double a : {0.1, 0.5, 1.0}) {
    const Cloth cloth = {a, 4, kWhite};
    EXPECT_NEAR(integral_over_hemisphere(1000, [&](Vec3 h) { return cloth.distribution(h) * h.z; }), 1, 1e-5)
        << "alpha " << a;
    const double printed = integral_over_hemisphere(1000, [&](Vec3 h) {
      const double sin2 = 1 - h.z * h.z;
      return h.z * (1 + 4 * std::exp(-h.z * h.z / sin2 / (a * a))) / (kPi * (1 + 4 * a * a));
    });
    EXPECT_NEAR(printed, of_21[i++], 5e-3) << "alpha " << a;
  }
}

TEST(Ggx, DistributionIsThatOfEquation2) {
  for (const double a : {0.1, 0.5, 1.0}) {
    for (const double zenith_deg : {0.0, 20.0, 70.0, 90.0}) {
      const Vec3 h = at_angles(zenith_deg, 30);
      const double root = h.z * h.z * (a * a - 1) + 1;
      const double equation_2 = a * a / (kPi * root * root);
      EXPECT_NEAR(GgxLobe(a, a).distribution(h) / equation_2, 1, 1e-9) << a << " at " << zenith_deg;
    }
  }
}

TEST(Ggx, ShadowingIsThatOfEquations3And6AndNot5) {
  const double a = 0.5, c = 0.5;
  const Vec3 v = at_angles(60);
  const double ours = 2 * c * GgxLobe(a, a).visibility(v);
  EXPECT_NEAR(ours, 2 / (1 + std::sqrt(1 + a * a * (1 - c * c) / (c * c))), 1e-12) << "eq. 3";
  EXPECT_NEAR(ours, 0.861, 5e-4);
  EXPECT_NEAR(2 * c / (c + std::sqrt(1 + a * a * (1 - c * c))), 0.629, 5e-4) << "eq. 5 as printed";
}

TEST(Ggx, ShadowingIsSchlicksWhereAlphaIsOne) {
  for (const double zenith_deg : {0.0, 30.0, 60.0, 85.0}) {
    const double c = at_angles(zenith_deg).z, k = 0.5;  // seed 002 eq. 4 with k = alpha / 2
    EXPECT_NEAR(2 * c * GgxLobe(1, 1).visibility(at_angles(zenith_deg)), c / (c * (1 - k) + k), 1e-12);
  }
}

/// What the facets seen from v show of themselves: G_1(v) D(h) max(0, v.h), which must be all of n.v.
template <typename Distribution>
double seen(const Distribution& distribution, double g1, Vec3 v) {
  return g1 *
         integral_over_hemisphere(500, [&](Vec3 h) { return distribution(h) * std::max(0.0, dot(v, h)); });
}

TEST(Ggx, ShadowingLeavesExactlyTheProjectedSurfaceWithTwoRoughnesses) {
  for (const double azimuth_deg : {0.0, 35.0, 90.0}) {
    for (const double zenith_deg : {20.0, 60.0, 80.0}) {
      const Vec3 v = at_angles(zenith_deg, azimuth_deg);
      const GgxLobe lobe(0.2, 0.7);
      EXPECT_NEAR(seen([&](Vec3 h) { return lobe.distribution(h); }, 2 * v.z * lobe.visibility(v), v) / v.z,
                  1, 2e-3)
          << "from " << zenith_deg << ", " << azimuth_deg;
    }
  }
}

TEST(Beckmann, ShadowingLeavesTheProjectedSurfaceToHalfAPercent) {
  for (const double a : {0.2, 0.5, 1.0}) {
    for (const double zenith_deg : {20.0, 60.0, 80.0}) {
      const Vec3 v = at_angles(zenith_deg, 35);
      const Beckmann model = {a};
      const double g1 = v.z * model.shadowing_over_cosine(v.z);
      EXPECT_NEAR(seen([&](Vec3 h) { return model.distribution(h); }, g1, v) / v.z, 1, 5e-3)
          << "alpha " << a << " from " << zenith_deg;
    }
  }
}

TEST(AnisotropicGgx, HighlightIsBroadAcrossTheFibresAndNarrowAlongThem) {
  const AnisotropicGgx satin = {0.5, 0.8};
  const Vec3 up = {0, 0, 1};
  EXPECT_GT(green(satin, kBlack, at_angles(40, 90), up), 5 * green(satin, kBlack, at_angles(40, 0), up));
}

TEST(AnisotropicGgx, IsGgxWithoutAnisotropy) {
  const Vec3 l = at_angles(50, 5), v = at_angles(40, 160);
  EXPECT_DOUBLE_EQ(green(AnisotropicGgx{0.4, 0}, kWhite, l, v), green(Ggx{0.4}, kWhite, l, v));
}

TEST(BlinnPhong, HighlightLiesWhereTheViewIsMirrored) {
  const Vec3 v = at_angles(30, 180);
  const BlinnPhong model = {0.7};
  const double mirror = green(model, kBlack, at_angles(30, 0), v);
  EXPECT_GT(mirror, green(model, kBlack, at_angles(25, 0), v));
  EXPECT_GT(mirror, green(model, kBlack, at_angles(35, 0), v)) << "(n.v)^m would not depend on the light";
  EXPECT_GT(mirror, green(model, kBlack, at_angles(30, 10), v));
}

TEST(BlinnPhong, HasTheNormAndVisibilityOfTheDocument) {
  // From straight above V = 1 and F = f0: f = f0 (m + 2) / (8 pi).
  const Vec3 up = {0, 0, 1};
  EXPECT_NEAR(green(BlinnPhong{0, {0.04, 0.04, 0.04}}, kBlack, up, up), 0.04 * 3 / (8 * kPi), 1e-12);
  EXPECT_NEAR(green(BlinnPhong{1, {0.04, 0.04, 0.04}}, kBlack, up, up), 0.04 * 8194 / (8 * kPi), 1e-9);
  // At gloss 0 the power is 1 and a = 1 / sqrt(3 pi / 4) = 0.6515.
  const double a = 0.6515, c = 0.5, factor = c * (1 - a) + a;
  const Vec3 l = at_angles(60, 0);
  EXPECT_NEAR(green(BlinnPhong{0, {0.04, 0.04, 0.04}}, kBlack, l, l),
              0.04 * 3 / (8 * kPi) * c / (factor * factor), 1e-6);
}

TEST(Fresnel, ApproximationsOfTheOtherDocumentsLieNearSchlick) {
  double seed_002 = 0, seed_004 = 0;
  for (double c = 0; c <= 1; c += 1e-3) {
    const double exponent = (-5.55473 * c - 6.98316) * c;
    seed_002 = std::max(seed_002, std::abs(schlick(0.0, c) - std::exp2(exponent)));
    seed_004 = std::max(seed_004, std::abs(schlick(0.0, c) - std::exp(-6 * c)));
  }
  EXPECT_NEAR(seed_002, 0.0037, 2e-4);
  EXPECT_NEAR(seed_004, 0.042, 1e-3);
}

TEST(Fresnel, BalancedDiffuseIsLambertLessWhatTheLobeReflects) {
  // Seed 000 eq. 15 at l.h = 1/2, where Schlick's F is 0.04 + 0.96 / 32 = 0.07.
  const Rgb f0 = {0.04, 0.04, 0.04}, albedo = {0.9, 0.5, 0.2};
  const Rgb f = lobe_over_diffuse(0, f0, Beneath::kBalanced, albedo, {0.3, 0.8, 0.5});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(f[c], 0.93 * albedo[c] / kPi, 1e-15) << "channel " << c;
}

TEST(Fresnel, CoupledDiffuseReflectsAllWithoutASurfaceAndAsPrintedThreeQuarters) {
  const auto reflected = [](const auto& f) {
    return integral_over_hemisphere(400, [&](Vec3 l) { return f(l) * l.z; });
  };
  const double ours = reflected([](Vec3 l) {
    return lobe_over_diffuse(0, kBlack, Beneath::kCoupled, kWhite, {l.z, 1, 0})[1];
  });
  EXPECT_NEAR(ours, 1, 1e-4);
  const double printed = reflected([](Vec3 l) { return 21 / (20 * kPi) * (1 - std::pow(l.z, 5)); });
  EXPECT_NEAR(printed, 0.75, 1e-4) << "seed 001 eq. 62, from above";
}

TEST(MultipleScattering, HasTheValuesOfItsFitWhereTheyAreKnown) {
  const Vec3 up = {0, 0, 1}, flat = {1, 0, 1e-12};
  EXPECT_NEAR(kPi * green(MultipleScattering{0}, kWhite, up, up), 1 + 24.5 * std::exp2(-8.9), 1e-12);
  EXPECT_NEAR(kPi * green(MultipleScattering{0}, kWhite, flat, flat), 1 + 24.5, 1e-2) << "back to the light";
  EXPECT_NEAR(kPi * green(MultipleScattering{1}, kWhite, up, up), 1, 1e-12);
  EXPECT_NEAR(kPi * green(MultipleScattering{1}, kWhite, at_angles(90 - 1e-9), up), 0.25, 1e-6);
}

TEST(MultipleScattering, HasTheValuesOfEquations64To69WorkedOutApart) {
  struct Row {
    double gloss, side_by_side,
        apart;  ///< pi f, both grazing 10 degrees apart, and well above 120 degrees apart
  };
  for (const Row& row :
       {Row{0.1, 6.1866614, 0.7917372}, Row{0.3, 3.5759261, 0.8061862}, Row{0.45, 1.4816597, 0.8598732},
        Row{0.6, 0.3656161, 0.9343375}, Row{0.9, 0.1577780, 0.9760491}}) {
    const MultipleScattering model = {row.gloss};
    EXPECT_NEAR(kPi * green(model, kWhite, at_angles(88, 0), at_angles(87, 10)), row.side_by_side, 1e-6);
    EXPECT_NEAR(kPi * green(model, kWhite, at_angles(60, 0), at_angles(40, 120)), row.apart, 1e-6);
  }
}

TEST(MultipleScattering, FollowsTheRationalFitOfTheRoughSlice) {
  // Seed 001 eq. 63, which includes the 1 / pi; n.h and l.h as cosines of angles from 0 to 60 degrees.
  const auto slice = [](double x, double y) {
    return (0.568 - 0.692 * x - 0.938 * y + 1.326 * x * x + 0.301 * y * y + 1.96 * x * y - 0.98 * x * x * x +
            1.533 * y * y * y) /
           (1 + 1.731 * x - 0.997 * y - 0.998 * x * x - 0.843 * y * y + 9.905 * x * y - 0.971 * x * x * x +
            0.948 * y * y * y);
  };
  EXPECT_NEAR(slice(1, 1), 0.315, 1e-3);
  double largest = 0;
  for (double theta_h = 0; theta_h <= 60; theta_h += 5) {
    for (double theta_d = 0; theta_d <= 60; theta_d += 5) {
      // phi_d = 90 degrees: light and view to either side of the plane of normal and half-vector.
      const Vec3 h = at_angles(theta_h), side = {0, std::sin(radians(theta_d)), 0};
      const Vec3 l = std::cos(radians(theta_d)) * h + side, v = std::cos(radians(theta_d)) * h - side;
      const double fit = slice(h.z, std::cos(radians(theta_d)));
      largest = std::max(largest, std::abs(green(MultipleScattering{0}, kWhite, l, v) / fit - 1));
    }
  }
  EXPECT_NEAR(largest, 0.10, 0.005) << "eq. 64-69 against eq. 63";
}

TEST(MultipleScattering, IsNeverNegativeWhereThePrintedFitIs) {
  const double g = 59.0 / 69;  // where the bump is deepest; light and view graze, 90 degrees apart
  const double l_h = std::sqrt(0.5);
  const double printed = 0.0625 + (34.5 * g * g - 59 * g + 24.5) * l_h;
  EXPECT_NEAR(printed, -0.45, 5e-3);
  EXPECT_EQ(green(MultipleScattering{g}, kWhite, {1, 0, 1e-12}, {0, 1, 1e-12}), 0);
}

TEST(OrenNayar, IsLambertWithoutSlopesAndShinesBackWithThem) {
  const Vec3 l = at_angles(60, 0);
  EXPECT_DOUBLE_EQ(green(OrenNayar{0}, kWhite, l, at_angles(30)), 1 / kPi);
  const double variance = 0.25, a = 1 - 0.5 * variance / (variance + 0.33);
  const double b = 0.45 * variance / (variance + 0.09);
  EXPECT_NEAR(kPi * green(OrenNayar{0.5}, kWhite, l, l),
              a + b * std::sin(radians(60)) * std::tan(radians(60)), 1e-12);
  EXPECT_NEAR(kPi * green(OrenNayar{0.5}, kWhite, l, at_angles(60, 180)), a, 1e-12);
}

TEST(DisneyDiffuse, HasBurleysFactorAtGrazingAngles) {
  const Vec3 flat = {1, 0, 1e-12};
  for (const double roughness : {0.0, 0.5, 1.0}) {
    const double fd90 = 0.5 + 2 * roughness;
    EXPECT_NEAR(kPi * green(DisneyDiffuse{roughness}, kWhite, flat, flat), fd90 * fd90, 1e-9);
    EXPECT_NEAR(kPi * green(DisneyDiffuse{roughness}, kWhite, {0, 0, 1}, {0, 0, 1}), 1, 1e-12);
  }
}

TEST(Cloth, GlowsAtTheRimInTheColourOfItsFibres) {
  const Cloth velvet = {0.3, 4, {0.04, 0.09, 0.2}};
  const Vec3 rim = at_angles(80), front = {0, 0, 1};
  EXPECT_GT(green(velvet, kBlack, rim, rim), 10 * green(velvet, kBlack, front, front))
      << "light behind the viewer";
  const Rgb f = evaluate(velvet, kBlack, rim, rim);
  EXPECT_NEAR(f[2] / f[0], 5, 1e-9) << "two tones: l.h is 1, so F is f0";
}

TEST(FibreCones, MirrorLightIntoAConeAboutThemselves) {
  const FibreCones fibres = {4, 3, 0, kWhite, Beneath::kLambert};
  const Vec3 l = at_angles(30);  // theta of 30 degrees
  for (const double phi_deg : {0.0, 40.0, -70.0}) {
    const auto reflected = [&](double theta_deg) {
      const double theta = radians(theta_deg), phi = radians(phi_deg);
      const Vec3 v = {std::sin(theta), std::cos(theta) * std::sin(phi), std::cos(theta) * std::cos(phi)};
      // The lobe without what depends on more than theta_h: cos^2 theta_d and what fibres hide.
      const double theta_d = radians((theta_deg - 30) / 2);
      return green(fibres, kBlack, l, v) * std::cos(theta_d) * std::cos(theta_d) * (l.z + v.z - l.z * v.z);
    };
    // theta_h is the tilt where theta is 2 x 3 - 30.
    const double top = reflected(-24);
    EXPECT_GT(top, reflected(-23)) << phi_deg;
    EXPECT_GT(top, reflected(-25)) << phi_deg;
    // A sigma of theta_h is two of theta.
    EXPECT_NEAR(reflected(-24 + 8) / top, std::exp(-0.5), 1e-12) << phi_deg;
    EXPECT_NEAR(top, std::cos(radians(phi_deg) / 2) / (8 * radians(4) * std::sqrt(2 * kPi)), 1e-9) << phi_deg;
  }
}

TEST(MixedGgx, IsTheShareOfEachOfItsLobes) {
  const Vec3 l = at_angles(40), v = at_angles(20, 170);
  const double a = green(Ggx{0.2}, kBlack, l, v), b = green(Ggx{0.6}, kBlack, l, v);
  EXPECT_NEAR(green(MixedGgx{0.2, 0.6, 0.25}, kBlack, l, v), 0.75 * a + 0.25 * b, 1e-12);
}

}  // namespace
}  // namespace weft::simulator
