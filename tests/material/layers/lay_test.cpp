// SPDX-License-Identifier: Apache-2.0
#include "material/layers/lay.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "core/base/vec.h"

namespace weft::material {
namespace {

constexpr Size kGrid = {37, 23};

using Values = std::array<double, 3>;

ParameterField made(int planes, const std::function<Values(int x, int y)>& at) {
  Image<float> map(kGrid, planes);
  for (int y = 0; y < kGrid.height; ++y) {
    for (int x = 0; x < kGrid.width; ++x) {
      const Values values = at(x, y);
      for (int p = 0; p < planes; ++p) map(x, y, p) = static_cast<float>(values[static_cast<std::size_t>(p)]);
    }
  }
  return ParameterField::of(std::move(map));
}

// Numbers from 0 to 1 without a pattern.
double noise(int x, int y, int seed) {
  const double t = std::sin(12.9898 * x + 78.233 * y + 37.719 * seed) * 43758.5453;
  return t - std::floor(t);
}

ParameterField noisy(int planes, int seed) {
  return made(planes, [&](int x, int y) {
    return Values{noise(x, y, seed), noise(x, y, seed + 1), noise(x, y, seed + 2)};
  });
}

double slope_angle_deg(double ax, double ay, double bx, double by) {
  return angle_deg({-ax, -ay, 1}, {-bx, -by, 1});
}

// Relief of two waves, and its slopes.
struct Waves {
  double mm, across, down;
  double height(int x, int y) const { return mm * std::sin(across * x + 0.3) * std::cos(down * y); }
  Values slopes(int x, int y) const {
    return {mm * across * std::cos(across * x + 0.3) * std::cos(down * y),
            mm * down * std::sin(across * x + 0.3) * std::sin(down * y), 0};
  }
};

TEST(Lay, OfThreeLayersIsTheBlendByHand) {
  const ParameterField base = noisy(3, 1);
  const std::array<ParameterField, 3> layers = {noisy(3, 11), noisy(3, 21),
                                                ParameterField::same({0.3, 0.2, 0.1}, 3)};
  const std::array<ParameterField, 3> masks = {noisy(1, 31), ParameterField::same(0.25), noisy(1, 41)};
  const std::array<double, 3> alphas = {0.8, 1, 0.5};
  ParameterField out = copy_of(base);
  for (std::size_t i = 0; i < layers.size(); ++i)
    ASSERT_TRUE(lay(Parameter::kAlbedo, out, layers[i], masks[i], {.alpha = alphas[i], .threads = 2}));
  double worst = 0;
  for (int y = 0; y < kGrid.height; ++y) {
    for (int x = 0; x < kGrid.width; ++x) {
      for (int p = 0; p < 3; ++p) {
        double by_hand = base.at(x, y, p);
        for (std::size_t i = 0; i < layers.size(); ++i) {
          const double weight = masks[i].at(x, y) * alphas[i];
          by_hand = (1 - weight) * by_hand + weight * layers[i].at(x, y, p);
        }
        worst = std::max(worst, std::abs(by_hand - out.at(x, y, p)));
      }
    }
  }
  EXPECT_LT(worst, 1e-6);
}

TEST(Lay, NormalsOfBlendedHeightsAreBlendedNormals) {
  const Waves a = {0.2, 0.7, 0.4}, b = {0.35, 0.3, 0.9};
  constexpr double kMask = 0.37;
  ParameterField below = made(2, [&](int x, int y) { return a.slopes(x, y); });
  const ParameterField layer = made(2, [&](int x, int y) { return b.slopes(x, y); });
  ASSERT_TRUE(lay(Parameter::kNormal, below, layer, ParameterField::same(kMask), {}));
  double worst = 0;
  for (int y = 0; y < kGrid.height; ++y) {
    for (int x = 0; x < kGrid.width; ++x) {
      // The slopes of (1 - m) h_a + m h_b.
      const Values sa = a.slopes(x, y), sb = b.slopes(x, y);
      worst = std::max(
          worst, slope_angle_deg(below.at(x, y, 0), below.at(x, y, 1), (1 - kMask) * sa[0] + kMask * sb[0],
                                 (1 - kMask) * sa[1] + kMask * sb[1]));
    }
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(Lay, DetailAddsReliefAndPatternWithoutTheirMeans) {
  ParameterField albedo = ParameterField::same({0.4, 0.2, 0.1}, 3),
                 normal = ParameterField::same({0.1, -0.2, 0}, 2), height = ParameterField::same(2);
  const ParameterField pattern = made(3, [](int x, int) {
    return x % 2 ? Values{0.9, 0.3, 0.5} : Values{0.3, 0.3, 0.5};
  });
  const ParameterField slopes = made(2, [](int x, int y) {
    return Values{x % 2 ? 0.5 : 0.1, y % 2 ? 0.2 : 0.0, 0};
  });
  const ParameterField relief = made(1, [](int x, int) { return Values{x % 2 ? 7.0 : 5.0, 0, 0}; });
  const LayOptions detail = {.blend = LayerBlend::kDetail};
  const ParameterField everywhere = ParameterField::same(1);
  const Values means = means_of(pattern), slope_means = means_of(slopes);
  ASSERT_TRUE(lay(Parameter::kAlbedo, albedo, pattern, everywhere, detail));
  ASSERT_TRUE(lay(Parameter::kNormal, normal, slopes, everywhere, detail));
  ASSERT_TRUE(lay(Parameter::kHeight, height, relief, everywhere, detail));
  EXPECT_NEAR(albedo.at(1, 0, 0), 0.4 * 0.9 / means[0], 1e-6);
  EXPECT_NEAR(albedo.at(1, 0, 1), 0.2, 1e-6);
  EXPECT_NEAR(normal.at(1, 1, 0), 0.1 + 0.5 - slope_means[0], 1e-6);
  EXPECT_NEAR(normal.at(1, 1, 1), -0.2 + 0.2 - slope_means[1], 1e-6);
  EXPECT_NEAR(means_of(height)[0], 2, 1e-6);
  ParameterField specular = ParameterField::same(0.3);
  ASSERT_TRUE(lay(Parameter::kSpecular, specular, ParameterField::same(0.9), everywhere, detail));
  EXPECT_EQ(specular.constant[0], 0.3);
}

TEST(Lay, GlossOfADetailIsThatOfFacetsOnFacets) {
  const LayOptions detail = {.blend = LayerBlend::kDetail};
  // Bases and details as alphas, with the single GGX nearest to them (docs/measured/filtering.md, Gloss).
  struct Joint {
    double base, detail, best;
  };
  for (const Joint& j : {Joint{0.1, 0.1, 0.171}, Joint{0.2, 0.3, 0.410}, Joint{0.5, 0.5, 0.713}}) {
    ParameterField roughness = ParameterField::same(std::sqrt(j.base));
    ASSERT_TRUE(lay(Parameter::kRoughness, roughness, ParameterField::same(std::sqrt(j.detail)),
                    ParameterField::same(1), detail));
    const double alpha = roughness.constant[0] * roughness.constant[0];
    EXPECT_NEAR(alpha / j.best, 1, 0.025) << j.base << " and " << j.detail << " became " << alpha;
    ParameterField masked = ParameterField::same(std::sqrt(j.base));
    ASSERT_TRUE(lay(Parameter::kRoughness, masked, ParameterField::same(std::sqrt(j.detail)),
                    ParameterField::same(0), detail));
    EXPECT_EQ(masked.constant[0], std::sqrt(j.base)) << "where nothing of it lies";
  }
}

TEST(Lay, ReorientedDetailKeepsItsAngleToATiltedBase) {
  ParameterField below = ParameterField::same({0.6, 0, 0}, 2);
  const ParameterField layer = made(2, [](int x, int) { return Values{0, x % 2 ? 0.5 : -0.5, 0}; });
  const double mean = means_of(layer)[1];
  ASSERT_TRUE(lay(Parameter::kNormal, below, layer, ParameterField::same(1),
                  {.blend = LayerBlend::kDetail, .normals = NormalBlend::kRnm}));
  for (const int x : {4, 5}) {
    const double alone = angle_deg({0, -(layer.at(x, 3, 1) - mean), 1}, {0, 0, 1});
    EXPECT_NEAR(slope_angle_deg(below.at(x, 3, 0), below.at(x, 3, 1), 0.6, 0), alone, 1e-4);
  }
}

TEST(Lay, AxesMeetOnTheShorterWay) {
  const auto axis = [](double strength, double deg) {
    const auto a = axis_of(strength, deg);
    return ParameterField::same({a[0], a[1], 0}, 2);
  };
  ParameterField below = axis(0.5, 170);
  ASSERT_TRUE(lay(Parameter::kAnisotropy, below, axis(0.5, 10), ParameterField::same(0.5), {}));
  const YarnAxis met = axis_from(below.constant[0], below.constant[1]);
  EXPECT_NEAR(std::remainder(met.azimuth_deg, 180), 0, 1e-9);
  EXPECT_NEAR(met.anisotropy, 0.5 * std::cos(radians(20)), 1e-12);
  ParameterField crossed = axis(0.5, 0);
  ASSERT_TRUE(lay(Parameter::kAnisotropy, crossed, axis(0.5, 90), ParameterField::same(0.5), {}));
  EXPECT_NEAR(axis_from(crossed.constant[0], crossed.constant[1]).anisotropy, 0, 1e-12);
}

TEST(Lay, KeepsWhatIsTheSameEverywhereANumber) {
  ParameterField below = ParameterField::same(0.5);
  ASSERT_TRUE(lay(Parameter::kRoughness, below, ParameterField::same(0.5), noisy(1, 3), {}));
  EXPECT_FALSE(below.is_map());
  ASSERT_TRUE(lay(Parameter::kRoughness, below, ParameterField::same(0.9), ParameterField::same(0.25), {}));
  EXPECT_FALSE(below.is_map());
  EXPECT_DOUBLE_EQ(below.constant[0], 0.6);
  ASSERT_TRUE(lay(Parameter::kRoughness, below, ParameterField::same(0.9), noisy(1, 3), {}));
  EXPECT_TRUE(below.is_map());
}

TEST(Lay, IsTheSameForAnyThreads) {
  std::array<ParameterField, 2> out = {noisy(3, 5), noisy(3, 5)};
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}})
    ASSERT_TRUE(lay(Parameter::kAlbedo, out[i], noisy(3, 6), noisy(1, 7),
                    {.blend = LayerBlend::kDetail, .threads = i == 0 ? 1 : 4}));
  for (int y = 0; y < kGrid.height; ++y) {
    for (int x = 0; x < kGrid.width; ++x) ASSERT_EQ(out[0].map(x, y, 1), out[1].map(x, y, 1));
  }
}

TEST(Lay, RefusesMapsOfDifferentSizes) {
  ParameterField below = noisy(1, 1);
  const Result<void> laid =
      lay(Parameter::kOpacity, below, ParameterField::of(Image<float>({3, 3})), ParameterField::same(1), {});
  ASSERT_FALSE(laid);
  EXPECT_EQ(laid.error().kind, ErrorKind::kUsage);
  EXPECT_NE(laid.error().why.find("3 x 3"), std::string::npos) << laid.error().message();
}

TEST(Slopes, OfANormalThatLooksAwayAreThoseOf89Degrees) {
  const auto steep = slopes_of_normal(-1, 0, -0.5);
  EXPECT_NEAR(degrees(std::atan(steep[0])), 89, 1e-9);
  EXPECT_EQ(slopes_of_normal(0, 0, 1)[0], 0);
  EXPECT_EQ(slopes_of_normal(0, 0, -1)[1], 0);
}

}  // namespace
}  // namespace weft::material
