// SPDX-License-Identifier: Apache-2.0
#include "material/assets/material_preview.h"

#include <gtest/gtest.h>

#include <cmath>

#include "simulator/reflectance/anisotropic_ggx.h"
#include "simulator/reflectance/cloth.h"

namespace weft::material {
namespace {

Vec3 toward(double zenith_deg, double azimuth_deg) {
  const double z = radians(zenith_deg), a = radians(azimuth_deg);
  return {std::sin(z) * std::cos(a), std::sin(z) * std::sin(a), std::cos(z)};
}

// The simulator's own arithmetic: a material of the weight is the mean of both lobes to 1e-6.
TEST(Shade, ClothAndGgxAreBlendedAsTheyReflect) {
  const Rgb albedo = {0.4, 0.2, 0.1}, sheen = {0.05, 0.06, 0.08};
  const double alpha = 0.45, anisotropy = 0.6, f0 = 0.05;
  const simulator::AnisotropicGgx ggx = {alpha, anisotropy, {f0, f0, f0}, simulator::Beneath::kBalanced};
  const simulator::Cloth fuzz = {.alpha = 0.5, .amplitude = 4, .f0 = sheen};
  for (const double weight : {0.0, 0.3, 1.0}) {
    const ShadedPoint point = {.albedo = albedo,
                               .alpha = alpha,
                               .alpha_along = alpha * (1 - anisotropy),
                               .yarn_deg = 0,
                               .f0 = f0,
                               .f0_tint = {1, 1, 1},
                               .metallic = 0,
                               .sheen = sheen,
                               .sheen_alpha = 0.5,
                               .cloth = weight};
    for (const double zenith : {10.0, 40.0, 70.0}) {
      for (const double azimuth : {0.0, 65.0, 200.0}) {
        const Vec3 light = toward(zenith, azimuth), view = toward(25, 130);
        const Rgb by_ggx = ggx.evaluate(albedo, light, view), by_cloth = fuzz.evaluate(albedo, light, view);
        const Rgb out = shaded(point, {0, 0, 1}, light, view);
        for (std::size_t c = 0; c < 3; ++c) {
          const double mean = kPi * light.z * ((1 - weight) * by_ggx[c] + weight * by_cloth[c]);
          EXPECT_NEAR(out[c], mean, 1e-6) << weight << " " << zenith << " " << azimuth;
        }
      }
    }
  }
}

TEST(Shade, IsDarkBelowTheSurfaceAndAMetalHasNoDiffusePart) {
  EXPECT_EQ(shaded({}, {0, 0, 1}, {0, 0, -1}, {0, 0, 1}), (Rgb{0, 0, 0}));
  ShadedPoint metal = {.albedo = {0.9, 0.6, 0.2}, .metallic = 1};
  metal.alpha = metal.alpha_along = 0.02;
  // Away from its narrow highlight nothing comes back.
  EXPECT_LT(shaded(metal, {0, 0, 1}, toward(60, 0), {0, 0, 1})[0], 0.01);
}

}  // namespace
}  // namespace weft::material
