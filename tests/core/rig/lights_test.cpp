// SPDX-License-Identifier: Apache-2.0
#include "core/rig/lights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace weft {
namespace {

using testing::HasSubstr;

// A spline whose coefficient (i, j) is f of its Greville abscissae, scaled to [-1, 1] over the frame.
template <typename F>
GainSpline spline_of(int columns, int rows, F f) {
  GainSpline spline = {columns, rows, {}};
  const auto abscissa = [](int i, int count) { return 2.0 * (i - 1) / (count - 3) - 1; };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i)
      spline.coefficients.push_back(f(abscissa(i, columns), abscissa(j, rows)));
  }
  return spline;
}

template <typename Check>
void at_many_places(Check check) {
  for (int j = 0; j <= 20; ++j) {
    for (int i = 0; i <= 20; ++i) check(i / 10.0 - 1, j / 10.0 - 1);
  }
}

constexpr std::array<std::array<int, 2>, 4> kSizes = {{{4, 4}, {5, 9}, {12, 8}, {4, 30}}};

TEST(GainSpline, OfEqualCoefficientsIsConstant) {
  for (const auto& [columns, rows] : kSizes) {
    const GainSpline spline = spline_of(columns, rows, [](double, double) { return 0.7; });
    at_many_places([&, columns = columns, rows = rows](double u, double v) {
      EXPECT_NEAR(spline.at(u, v), 0.7, 1e-15) << "at " << u << ", " << v << ", " << columns << " x " << rows;
    });
  }
}

TEST(GainSpline, ReproducesALinearFunctionFromItsGrevilleAbscissae) {
  const auto linear = [](double u, double v) { return 0.3 - 1.7 * u + 0.9 * v; };
  for (const auto& [columns, rows] : kSizes) {
    const GainSpline spline = spline_of(columns, rows, linear);
    at_many_places([&, columns = columns, rows = rows](double u, double v) {
      EXPECT_NEAR(spline.at(u, v), linear(u, v), 1e-14)
          << "at " << u << ", " << v << ", " << columns << " x " << rows;
    });
  }
}

// De Boor, A Practical Guide to Splines: the cardinal cubic is 2/3 at its own knot and 1/6 at the next ones.
TEST(GainSpline, HasTheValuesOfTheCardinalCubicAtTheKnots) {
  GainSpline spline = {7, 7, std::vector<double>(49)};
  spline.coefficients[7 * 3 + 3] = 1;
  EXPECT_NEAR(spline.at(0, 0), 4.0 / 9, 1e-15);
  EXPECT_NEAR(spline.at(0.5, 0), 1.0 / 9, 1e-15);
  EXPECT_NEAR(spline.at(0.5, -0.5), 1.0 / 36, 1e-15);
  EXPECT_NEAR(spline.at(1, 0), 0, 1e-15);
  EXPECT_NEAR(spline.at(0.25, 0), 2.0 / 3 * 23 / 48, 1e-15);
}

TEST(GainSpline, StaysAtItsEdgeBeyondTheFrame) {
  const GainSpline spline = spline_of(5, 5, [](double u, double v) { return u + 10 * v; });
  EXPECT_NEAR(spline.at(1.2, -3), spline.at(1, -1), 1e-15);
  EXPECT_EQ(GainSpline().at(0.3, 0.3), 0) << "an empty spline is no gain";
}

TEST(NearLights, GainIsTheSharedSplineOfTheChannelPlusTheLedsOwnQuadratic) {
  NearLights lights;
  lights.leds.resize(2);
  lights.leds[1].log_gain_quadratic = {1, 2, 3, 4, 5, 6};
  lights.log_gain_rgb[2] = spline_of(4, 4, [](double u, double v) { return 100 * u + 1000 * v; });
  const double u = 0.5, v = -0.25;
  const double own = 1 + 2 * u + 3 * v + 4 * u * u + 5 * u * v + 6 * v * v;
  EXPECT_NEAR(lights.log_gain(1, 0, u, v), own, 1e-13);
  EXPECT_NEAR(lights.log_gain(1, 2, u, v), own + 100 * u + 1000 * v, 1e-12);
  EXPECT_NEAR(lights.log_gain(0, 2, u, v), 100 * u + 1000 * v, 1e-12);
}

Lights near_lights() {
  NearLights lights;
  for (int k = 1; k <= 5; ++k) lights.leds.push_back({.position_mm = {100.0 * k, 0, 500}, .aim = {0, 0, -1}});
  lights.log_gain_rgb[1] = spline_of(4, 4, [](double u, double) { return u; });
  return lights;
}

Lights distant_lights() {
  DistantLights lights;
  for (int k = 1; k <= 5; ++k) lights.lights.push_back({normalized({0.1 * k, 0, 1}), {1.0 * k, 1, 1}});
  return lights;
}

TEST(SelectLights, KeepsTheOrderAskedForAndTheSharedGain) {
  const Result<Lights> near = select_lights(near_lights(), {4, 1});
  ASSERT_TRUE(near) << near.error().message();
  EXPECT_EQ(light_count(*near), 2U);
  EXPECT_EQ(std::get<NearLights>(*near).leds[0].position_mm.x, 400);
  EXPECT_EQ(std::get<NearLights>(*near).leds[1].position_mm.x, 100);
  EXPECT_EQ(std::get<NearLights>(*near).log_gain_rgb[1].coefficients.size(), 16U);
  const Result<Lights> distant = select_lights(distant_lights(), {5, 2, 3});
  ASSERT_TRUE(distant) << distant.error().message();
  EXPECT_EQ(light_count(*distant), 3U);
  EXPECT_EQ(std::get<DistantLights>(*distant).lights[0].irradiance_rgb[0], 5);
}

TEST(WhiteGains, MakeWhitePaperGreyUnderAllLights) {
  const DistantLights two = {{{{0, 0, 1}, {1, 2, 4}}, {{0, 0, 1}, {3, 6, 0}}}};
  EXPECT_EQ(white_gains(two), (std::array<double, 3>{2, 1, 2}));
  const DistantLights blind = {{{{0, 0, 1}, {0, 2, 4}}}};
  EXPECT_FALSE(white_gains(blind)) << "there is no red to be brightened";
}

TEST(SelectLights, RefusesALightThatIsNotThereOrIsNamedTwice) {
  for (const Lights& lights : {near_lights(), distant_lights()}) {
    for (const int absent : {0, -1, 6, 2147483647}) {
      const Result<Lights> selected = select_lights(lights, {1, absent});
      ASSERT_FALSE(selected) << absent;
      EXPECT_EQ(selected.error().kind, ErrorKind::kUsage);
      EXPECT_EQ(selected.error().where, "light " + std::to_string(absent));
      EXPECT_THAT(selected.error().why, HasSubstr("from 1 to 5"));
    }
    const Result<Lights> twice = select_lights(lights, {3, 1, 3});
    ASSERT_FALSE(twice);
    EXPECT_EQ(twice.error().kind, ErrorKind::kUsage);
    EXPECT_EQ(twice.error().message(), "a light is named twice: light 3. name every light once.");
  }
}

}  // namespace
}  // namespace weft
