// SPDX-License-Identifier: Apache-2.0
// The white furnace: what comes to the viewer where light of radiance 1 comes from everywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "tests/simulator/reflectance/measured.h"

namespace weft::simulator {
namespace {

constexpr Rgb kFibre = {0.04, 0.04, 0.04};
constexpr std::array<double, 3> kZeniths_deg = {0, 60, 85};

struct Furnace {
  std::string name;
  Reflectance model;
  std::array<double, 3> reflected;  ///< to views at kZeniths_deg and azimuth 20 degrees
};

void expect_table(const std::vector<Furnace>& table, const Rgb& albedo) {
  for (const Furnace& each : table) {
    for (std::size_t i = 0; i < kZeniths_deg.size(); ++i) {
      EXPECT_NEAR(directional_albedo(each.model, albedo, at_angles(kZeniths_deg[i], 20), 300),
                  each.reflected[i], 1.5e-3)
          << each.name << " seen from " << kZeniths_deg[i] << " degrees";
    }
  }
}

TEST(WhiteFurnace, ModelsOverWhiteReflectWhatTheirTableSays) {
  expect_table({{"Lambert", Lambert(), {1, 1, 1}},
                {"Oren-Nayar 0.5", OrenNayar{0.5}, {0.785, 0.883, 0.940}},
                {"Disney 0", DisneyDiffuse{0}, {0.976, 0.961, 0.667}},
                {"Disney 1", DisneyDiffuse{1}, {1.036, 1.057, 1.400}},
                {"multiple scattering 0", MultipleScattering{0}, {0.973, 0.939, 1.055}},
                {"multiple scattering 1", MultipleScattering{1}, {0.964, 0.942, 0.506}},
                {"GGX 0.5 over Lambert", Ggx{0.5, kFibre, Beneath::kLambert}, {1.028, 1.037, 1.079}},
                {"GGX 0.5 balanced", Ggx{0.5, kFibre, Beneath::kBalanced}, {0.988, 0.992, 1.018}},
                {"GGX 0.1 balanced", Ggx{0.1, kFibre, Beneath::kBalanced}, {1.000, 1.025, 1.266}},
                {"GGX 0.5 coupled", Ggx{0.5, kFibre, Beneath::kCoupled}, {0.988, 0.967, 0.431}},
                {"cloth 0.3", Cloth{0.3, 4, kFibre}, {0.967, 0.966, 0.974}}},
               kWhite);
}

TEST(WhiteFurnace, MirroringLobesLoseWhatFacetsShadow) {
  expect_table(
      {{"GGX 0.1", Ggx{0.1, kWhite, Beneath::kLambert}, {0.988, 0.969, 0.873}},
       {"GGX 0.5", Ggx{0.5, kWhite, Beneath::kLambert}, {0.688, 0.686, 0.777}},
       {"GGX 1", Ggx{1, kWhite, Beneath::kLambert}, {0.307, 0.409, 0.565}},
       {"anisotropic GGX 0.5, 0.5",
        AnisotropicGgx{0.5, 0.5, kWhite, Beneath::kLambert},
        {0.790, 0.749, 0.789}},
       {"Beckmann 0.5", Beckmann{0.5, kWhite, Beneath::kLambert}, {0.943, 0.872, 0.942}},
       {"Blinn-Phong 0.5", BlinnPhong{0.5, kWhite, Beneath::kLambert}, {0.995, 0.783, 0.341}},
       {"cloth 0.3", Cloth{0.3, 4, kWhite}, {0.184, 0.244, 0.567}},
       {"fibres 6", FibreCones{6, 0, 0, kWhite, Beneath::kLambert}, {0.456, 0.587, 0.980}},
       {"fibres 6, seen across", FibreCones{6, 0, 110, kWhite, Beneath::kLambert}, {0.456, 0.451, 0.466}}},
      kBlack);
}

TEST(WhiteFurnace, NoLobeAloneReflectsMoreThanItReceives) {
  for (const double x : {0.0, 0.2, 0.4, 0.7, 1.0}) {
    for (const double zenith_deg : {0.0, 30.0, 60.0, 80.0, 90.0}) {
      for (const Reflectance& lobe :
           {Reflectance(Ggx{x, kWhite, Beneath::kLambert}),
            Reflectance(AnisotropicGgx{0.5, x, kWhite, Beneath::kLambert}),
            Reflectance(Beckmann{x, kWhite, Beneath::kLambert}),
            Reflectance(BlinnPhong{x, kWhite, Beneath::kLambert}), Reflectance(Cloth{x, 4, kWhite})}) {
        EXPECT_LT(directional_albedo(lobe, kBlack, at_angles(zenith_deg, 20), 100), 1.01)
            << "model " << lobe.index() << " of " << x << " from " << zenith_deg;
      }
    }
  }
}

TEST(WhiteFurnace, ClothAndCoupledLobesKeepEnergyOverWhite) {
  for (const double x : {0.0, 0.1, 0.3, 0.6, 1.0}) {
    for (const double f0 : {0.0, 0.04, 0.3, 1.0}) {
      for (const double zenith_deg : {0.0, 30.0, 60.0, 80.0, 90.0}) {
        const Rgb grey = {f0, f0, f0};
        for (const Reflectance& model :
             {Reflectance(Cloth{x, 4, grey}), Reflectance(Ggx{x, grey, Beneath::kCoupled})}) {
          EXPECT_LT(directional_albedo(model, kWhite, at_angles(zenith_deg), 100), 1.005)
              << "model " << model.index() << " of " << x << ", f0 " << f0 << " from " << zenith_deg;
        }
      }
    }
  }
}

// A cone that leans by its scales has no partner at grazing angles.
TEST(WhiteFurnace, ConesOfFibresGiveTooMuchWhereTheyGraze) {
  const auto mirrored = [](double spread_deg, double tilt_deg, double zenith_deg) {
    const FibreCones fibres = {spread_deg, tilt_deg, 0, kWhite, Beneath::kLambert};
    return directional_albedo(fibres, kBlack, at_angles(zenith_deg), 300);
  };
  for (const double spread_deg : {3.0, 6.0, 20.0}) EXPECT_LT(mirrored(spread_deg, 2, 70), 1) << spread_deg;
  EXPECT_GT(mirrored(6, 0, 90), 1.2);
  EXPECT_GT(mirrored(13, 4, 90), 3);
}

TEST(WhiteFurnace, FiveModelsGiveTooMuchAtGrazingAnglesOverWhite) {
  const Vec3 grazing = at_angles(90);
  EXPECT_NEAR(directional_albedo(DisneyDiffuse{1}, kWhite, grazing), 1.557, 2e-3);
  EXPECT_NEAR(directional_albedo(MultipleScattering{0}, kWhite, grazing), 1.156, 2e-3);
  EXPECT_NEAR(directional_albedo(Ggx{0.1, kFibre, Beneath::kBalanced}, kWhite, grazing), 1.303, 2e-3);
  EXPECT_NEAR(directional_albedo(Ggx{0.1, kFibre, Beneath::kLambert}, kWhite, grazing), 1.370, 2e-3);
  EXPECT_NEAR(directional_albedo(OrenNayar{0.3}, kWhite, grazing), 1.005, 3e-3);
}

}  // namespace
}  // namespace weft::simulator
