// SPDX-License-Identifier: Apache-2.0
#include "report/preview.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/vec.h"
#include "core/solve/solve_record.h"
#include "tests/report/not_finite.h"

namespace weft::report {
namespace {

Image<float> vectors(Size size, Vec3 v) {
  Image<float> image(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      image(x, y, 0) = static_cast<float>(v.x);
      image(x, y, 1) = static_cast<float>(v.y);
      image(x, y, 2) = static_cast<float>(v.z);
    }
  }
  return image;
}

std::array<View<const float>, 3> views_of(const Image<float>& image) {
  return {image.plane(0), image.plane(1), image.plane(2)};
}

void expect_near(Colour got, Colour wanted, double tolerance) {
  EXPECT_NEAR(got.r, wanted.r, tolerance);
  EXPECT_NEAR(got.g, wanted.g, tolerance);
  EXPECT_NEAR(got.b, wanted.b, tolerance);
}

TEST(Srgb, FollowsIec61966) {
  EXPECT_EQ(srgb_from_linear(0), 0.0f);
  EXPECT_NEAR(srgb_from_linear(0.001f), 0.01292f, 1e-7);
  EXPECT_NEAR(srgb_from_linear(0.18f), 0.46135612950f, 1e-6);
  EXPECT_NEAR(srgb_from_linear(0.5f), 0.73535698305f, 1e-6);
  EXPECT_NEAR(srgb_from_linear(1), 1.0f, 1e-6);
  EXPECT_EQ(srgb_from_linear(-1), 0.0f);
  EXPECT_NEAR(srgb_from_linear(7), 1.0f, 1e-6);
  for (int i = 1; i < 1000; ++i) {
    const double c = i * 1e-3, v = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    ASSERT_NEAR(srgb_from_linear(static_cast<float>(c)), v, 2e-7) << c;
  }
}

TEST(AlbedoPicture, EncodesTheScaledReflectance) {
  const Picture picture = albedo_picture(vectors({3, 2}, {0.09, 0.25, 2.0}), 2);
  expect_near(colour_at(picture, 2, 1), {0.46135613f, 0.73535698f, 1.0f}, 1e-6);
}

TEST(AlbedoPicture, ShowsPixelsThatAreNotFiniteInMagenta) {
  Image<float> albedo = vectors({3, 1}, {0.5, 0.5, 0.5});
  albedo(0, 0, 2) = kNan;
  albedo(1, 0, 0) = kInf;
  const Picture picture = albedo_picture(albedo);
  EXPECT_EQ(colour_at(picture, 0, 0), kMissing);
  EXPECT_EQ(colour_at(picture, 1, 0), kMissing);
  EXPECT_NE(colour_at(picture, 2, 0), kMissing);
}

TEST(DisplayScale, BringsTheBrightPartToFourFifths) {
  EXPECT_NEAR(display_scale(vectors({10, 10}, {0.1, 0.4, 0.2})), 2.0, 1e-6);
  Image<float> albedo = vectors({20, 20}, {0.1, 0.4, 0.2});
  albedo(3, 3, 0) = 1000;  // a glint does not darken the cloth
  albedo(4, 4, 1) = kNan;
  EXPECT_NEAR(display_scale(albedo), 2.0, 1e-6);
  EXPECT_EQ(display_scale(vectors({4, 4}, {0, 0, 0})), 1.0);
  EXPECT_EQ(display_scale(vectors({4, 4}, {kNan, kNan, kNan})), 1.0);
}

TEST(NormalPicture, MapsUnitVectorsToTheUnitCubeWithGreenUp) {
  expect_near(colour_at(normal_picture(vectors({1, 1}, {0, 0, 1})), 0, 0), {0.5f, 0.5f, 1.0f}, 1e-7);
  expect_near(colour_at(normal_picture(vectors({1, 1}, {0, 0.6, 0.8})), 0, 0), {0.5f, 0.8f, 0.9f}, 1e-7);
  expect_near(colour_at(normal_picture(vectors({1, 1}, {-0.06, 0, 0.08})), 0, 0), {0.2f, 0.5f, 0.9f}, 1e-7);
  EXPECT_EQ(colour_at(normal_picture(vectors({1, 1}, {0, 0, 0})), 0, 0), kMissing);
  EXPECT_EQ(colour_at(normal_picture(vectors({1, 1}, {0, kInf, 0})), 0, 0), kMissing);
}

TEST(RelitPicture, ShowsFlatClothAsItsAlbedo) {
  const Image<float> albedo = vectors({2, 2}, {0.1, 0.3, 0.6});
  const Picture relit = relit_picture(albedo, vectors({2, 2}, {0, 0, 1}));
  expect_near(colour_at(relit, 1, 1), colour_at(albedo_picture(albedo), 1, 1), 1e-6);
}

TEST(RelitPicture, IsLambertianUnderALampFromTheUpperLeft) {
  const Image<float> albedo = vectors({1, 1}, {0.2, 0.2, 0.2});
  const auto shown = [&](Vec3 n) { return colour_at(relit_picture(albedo, vectors({1, 1}, n)), 0, 0).r; };
  const double facing = 0.2 * (0.15 + 0.85 * std::sqrt(2.0));  // l_z is cos 45
  EXPECT_NEAR(shown({-0.5, 0.5, std::sqrt(0.5)}), srgb_from_linear(static_cast<float>(facing)), 1e-5);
  EXPECT_NEAR(shown({0.5, -0.5, 0.1}), srgb_from_linear(0.2f * 0.15f), 1e-5) << "turned away: ambient only";
  EXPECT_GT(shown({-0.3, 0, 0.95}), shown({0.3, 0, 0.95})) << "the left is lit";
  EXPECT_GT(shown({0, 0.3, 0.95}), shown({0, -0.3, 0.95})) << "the top is lit";
}

TEST(RelitPicture, IsMagentaWhereThereIsNoNormal) {
  const Image<float> albedo = vectors({1, 1}, {0.2, 0.2, 0.2});
  EXPECT_EQ(colour_at(relit_picture(albedo, vectors({1, 1}, {0, 0, kNan})), 0, 0), kMissing);
}

TEST(AngularError, IsTheTiltOfATiltedMap) {
  const Size size{5, 4};
  Image<float> error(size);
  for (const double tilt_deg : {0.0, 1e-3, 0.1, 3.0, 45.0, 120.0}) {
    const double tilt = radians(tilt_deg);
    const Image<float> normal = vectors(size, {std::sin(tilt), 0, std::cos(tilt)});
    angular_error_deg(views_of(normal), views_of(vectors(size, {0, 0, 2})), error.plane());
    EXPECT_NEAR(error(4, 3), tilt_deg, 1e-5 + 1e-6 * tilt_deg);
  }
  for (const Vec3 none : {Vec3{0, 0, 0}, Vec3{kNan, 0, 1}}) {
    angular_error_deg(views_of(vectors(size, {0, 0, 1})), views_of(vectors(size, none)), error.plane());
    EXPECT_TRUE(std::isnan(error(0, 0)));
  }
}

TEST(HeatColour, RisesEvenlyInLightnessAndStaysInsideSrgb) {
  // OKLab's lightness of an sRGB colour (Ottosson 2020).
  const auto lightness = [](Colour c) {
    const auto linear = [](double v) {
      return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    const double r = linear(c.r), g = linear(c.g), b = linear(c.b);
    return 0.2104542553 * std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b) +
           0.7936177850 * std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b) -
           0.0040720468 * std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  };
  for (int i = 0; i <= 100; ++i) {
    ASSERT_NEAR(lightness(heat_colour(i * 0.01)), 0.25 + 0.67 * i * 0.01, 0.003) << i;
  }
  EXPECT_EQ(heat_colour(-1), heat_colour(0));
  EXPECT_EQ(heat_colour(2), heat_colour(1));
}

TEST(RoundFullScale, CoversNinetyNineOfAHundredWithOneDigit) {
  Image<float> values({100, 10});
  const auto full_scale_of = [&](float value) {
    for (int y = 0; y < 10; ++y) std::fill_n(values.plane().row(y), 100, value);
    values(0, 0) = 1e9f;
    values(1, 0) = kNan;
    return round_full_scale(values.plane());
  };
  EXPECT_NEAR(full_scale_of(0.31f), 0.4, 1e-9);
  EXPECT_NEAR(full_scale_of(2.0f), 2.0, 1e-9);
  EXPECT_NEAR(full_scale_of(0.97f), 1.0, 1e-9);
  EXPECT_NEAR(full_scale_of(1234.0f), 2000, 1e-6);
  EXPECT_GT(full_scale_of(0), 0) << "a map without error still has a scale";
  EXPECT_GT(full_scale_of(kNan), 0);
}

TEST(HeatPicture, OfAConstantHasOneColourOverItsScaleBar) {
  const Size size{300, 200};
  const Image<float> tilt = vectors(size, {2.0, 2.0, 2.0});
  const Picture picture = heat_picture(tilt.plane(0), 4);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x)
      ASSERT_EQ(colour_at(picture, x, y), heat_colour(0.5)) << x << ", " << y;
  }
  EXPECT_GT(picture.height(), size.height);
  EXPECT_EQ(picture.width(), size.width);
  const int bar = size.height + 6;
  EXPECT_EQ(colour_at(picture, 0, bar), heat_colour(0));
  EXPECT_EQ(colour_at(picture, 299, bar), heat_colour(1));
}

TEST(HeatPicture, HoldsValuesBeyondItsScaleAndShowsMissingOnes) {
  Image<float> values({300, 4});
  values(0, 0) = 7;
  values(1, 0) = kNan;
  values(2, 0) = -kInf;
  const Picture picture = heat_picture(values.plane(), 5);
  EXPECT_EQ(colour_at(picture, 0, 0), heat_colour(1));
  EXPECT_EQ(colour_at(picture, 1, 0), kMissing);
  EXPECT_EQ(colour_at(picture, 2, 0), kMissing);
  EXPECT_EQ(colour_at(picture, 3, 0), heat_colour(0));
}

TEST(HeatPicture, IsDrawnWhateverItsSizeAndScale) {
  for (const double full_scale : {0.0, -1.0, 1e-12, 3.7, 1e12, double{kNan}, double{kInf}}) {
    for (const Size size : {Size{1, 1}, Size{17, 3}, Size{2000, 2}}) {
      const Image<float> values(size);
      const Picture picture = heat_picture(values.plane(), full_scale);
      EXPECT_EQ(colour_at(picture, 0, 0), heat_colour(0)) << full_scale;
    }
  }
}

TEST(StatusPreview, ShowsEachPixelInTheColourOfItsGravestBit) {
  Image<std::uint16_t> status({5, 1});
  status(0, 0) = kNoSolution | kDark | kShadowed;
  status(1, 0) = kNoSolution;
  status(2, 0) = kShadowed;
  status(3, 0) = kShadowed | kSaturated;
  StatusPreview preview(status.size());
  preview.add_rows(status.plane());
  const Picture picture = preview.picture();
  expect_near(colour_at(picture, 0, 0), kMissing, 1e-6);
  expect_near(colour_at(picture, 1, 0), kMissing, 1e-6);
  EXPECT_NE(colour_at(picture, 2, 0), colour_at(picture, 3, 0));
  EXPECT_NE(colour_at(picture, 2, 0), colour_at(picture, 4, 0));
}

TEST(StatusPreview, IsTheSameForAnyBands) {
  Image<std::uint16_t> status({130, 70});
  for (int y = 0; y < 70; ++y) {
    for (int x = 0; x < 130; ++x) status(x, y) = static_cast<std::uint16_t>((x * y * 7 + x) % 65536);
  }
  const View<const std::uint16_t> view = status.plane();
  StatusPreview whole(status.size(), 40), banded(status.size(), 40);
  whole.add_rows(view);
  for (int y = 0; y < 70; y += 9) banded.add_rows(view.crop({0, y, 130, std::min(y + 9, 70)}));
  const Picture a = whole.picture(), b = banded.picture();
  ASSERT_EQ(a.size(), b.size());
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) ASSERT_EQ(colour_at(a, x, y), colour_at(b, x, y)) << x << ", " << y;
  }
}

TEST(LobePicture, HasAColourForEachDirectionAndGreyWhereNoLobeHolds) {
  Image<float> shares({3, 1}, 2);
  shares(1, 0, 0) = shares(2, 0, 1) = 1;
  const std::array<LobeKey, 2> crossed = {{{"warp", 0.0}, {"weft", 90.0}}};
  const std::array<LobeKey, 2> turned = {{{"warp", 90.0}, {"weft", 180.0}}};
  const Picture a = lobe_picture(shares, crossed), b = lobe_picture(shares, turned);
  EXPECT_EQ(colour_at(a, 0, 0), colour_at(b, 0, 0));
  EXPECT_NEAR(colour_at(a, 1, 0).r, colour_at(b, 2, 0).r, 1e-5);
  EXPECT_NEAR(colour_at(a, 2, 0).g, colour_at(b, 1, 0).g, 1e-5);
  EXPECT_GT(std::abs(colour_at(a, 1, 0).r - colour_at(a, 2, 0).r), 0.3);
  EXPECT_GT(a.height(), shares.height()) << "there is a legend";
}

TEST(LobePicture, IsPalerOfTheSecondMaterial) {
  Image<float> shares({2, 1}, 2);
  shares(0, 0, 0) = shares(1, 0, 1) = 1;
  const std::array<LobeKey, 2> two = {{{"one"}, {.says = "other", .is_second = true}}};
  const Picture picture = lobe_picture(shares, two);
  EXPECT_GT(colour_at(picture, 1, 0).b, colour_at(picture, 0, 0).b + 0.1F);
}

}  // namespace
}  // namespace weft::report
