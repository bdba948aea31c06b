// SPDX-License-Identifier: Apache-2.0
#include "solver/uncertainty/calibration_sigma.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <utility>

#include "bench/oracles/oracle_rig.h"

namespace weft::solver {
namespace {

constexpr Size kFrame = {400, 260};  // 200 x 130 mm

std::vector<int> numbers(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 1);
  return all;
}

LightField field_of(const NearLights& lights) {
  return LightField::make(Lights(lights), overhead_camera(kFrame, 600, 0.5), kFrame, 0).value();
}

// Independent parameters of all ten LEDs.
struct Independent {
  std::vector<std::string> names;  // "position_mm.x"
  std::vector<double> sigmas;
};
ParameterCovariance covariance_of(const Independent& each) {
  ParameterCovariance covariance;
  std::vector<double> variances;
  for (int led = 1; led <= 10; ++led) {
    for (std::size_t i = 0; i < each.names.size(); ++i) {
      covariance.parameters.push_back(fmt::format("led{:02}.{}", led, each.names[i]));
      variances.push_back(each.sigmas[i] * each.sigmas[i]);
    }
  }
  const std::size_t n = variances.size();
  covariance.matrix.resize(n * n);
  for (std::size_t i = 0; i < n; ++i) covariance.matrix[i * n + i] = variances[i];
  return covariance;
}
ParameterCovariance position_covariance(double sigma_mm) {
  return covariance_of({{"position_mm.x", "position_mm.y", "position_mm.z"}, {sigma_mm, sigma_mm, sigma_mm}});
}

Vec3 tilted(double tilt_deg, double azimuth_deg) {
  const double t = radians(tilt_deg), a = radians(azimuth_deg);
  return {std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)};
}

// Rms over eight azimuths at the centre of the frame.
double at_centre(const CalibrationSigmas& sigmas, double tilt_deg) {
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const double deg = sigmas.at(200, 130, 1, tilted(tilt_deg, 45.0 * i), 0.5).normal_deg;
    sum += deg * deg / 8;
  }
  return std::sqrt(sum);
}

// The least-squares solution under `assumed` of what the cloth sends back under `actual`.
Vec3 solved(const LightField& actual, const LightField& assumed, int x, int y, Vec3 normal, double albedo) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
  Eigen::Vector3d h = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 10; ++k) {
    const LightField::Light a = actual.at(k, 1, x, y), b = assumed.at(k, 1, x, y);
    const double cosine = dot(normal, a.direction);
    if (cosine <= 0) continue;
    const Eigen::Vector3d l(b.direction.x, b.direction.y, b.direction.z);
    g += l * l.transpose();
    h += albedo * a.strength * cosine / b.strength * l;
  }
  const Eigen::Vector3d s = g.ldlt().solve(h);
  return {s.x(), s.y(), s.z()};
}

TEST(CalibrationSigma, OfLedsFiveMillimetresOffIsHalfADegree) {
  // Monte Carlo of a prototype, good to about 5 percent, at tilts of 0, 20 and 40 degrees: 5 mm .53 .51 .62;
  // 1 percent of flux .28 .26 .32.
  const LightField field = field_of(test::ten_leds());
  const auto of = [&](const ParameterCovariance& covariance) {
    return CalibrationSigmas::make(field, kFrame, numbers(10), covariance, {}).value();
  };
  const CalibrationSigmas five_mm = of(position_covariance(5)),
                          one_percent = of(covariance_of({{"log_flux"}, {0.01}}));
  const std::array<double, 3> tilts = {0, 20, 40}, five = {0.53, 0.51, 0.62}, one = {0.28, 0.26, 0.32};
  for (std::size_t i = 0; i < tilts.size(); ++i) {
    RecordProperty("five_mm_" + std::to_string(i), std::to_string(at_centre(five_mm, tilts[i])));
    RecordProperty("one_percent_" + std::to_string(i), std::to_string(at_centre(one_percent, tilts[i])));
    EXPECT_NEAR(at_centre(five_mm, tilts[i]) / five[i], 1, 0.05) << "5 mm at " << tilts[i] << " degrees";
    EXPECT_NEAR(at_centre(one_percent, tilts[i]) / one[i], 1, 0.1)
        << "1 percent at " << tilts[i] << " degrees";
  }
}

TEST(CalibrationSigma, OfIndependentFluxesOverALevelClothIsTheClosedForm) {
  // n = z and rings at zenith angles t: d b_x has variance sum (sin t cos t)^2 / 2 over (sum sin^2 t / 2)^2.
  double change = 0, fit = 0;
  for (const auto& [count, zenith_deg] : {std::pair{4, 35.0}, {6, 62.0}}) {
    const double s = std::sin(radians(zenith_deg)), c = std::cos(radians(zenith_deg));
    change += count * s * s * c * c / 2;
    fit += count * s * s / 2;
  }
  const Size odd = {401, 261};  // whose centre is a pixel
  const LightField field =
      LightField::make(Lights(test::ten_leds()), overhead_camera(odd, 600, 0.5), odd, 0).value();
  const CalibrationSigma sigma =
      CalibrationSigmas::make(field, odd, numbers(10), covariance_of({{"log_flux"}, {0.01}}), {})
          .value()
          .at(200, 130, 1, {0, 0, 1}, 0.5);
  EXPECT_NEAR(sigma.normal_deg, degrees(0.01 * std::sqrt(2 * change) / fit), 1e-6);
}

TEST(CalibrationSigma, IsWhatAThousandPerturbedRigsShow) {
  const NearLights lights = test::ten_leds(1.3);
  const LightField field = field_of(lights);
  const Independent each = {{"position_mm.x", "position_mm.y", "position_mm.z", "aim.x", "aim.y", "mu",
                             "log_flux", "log_gain_quadratic.1"},
                            {2, 3, 1, 0.01, 0.005, 0.02, 0.005, 0.004}};
  const CalibrationSigmas sigmas =
      CalibrationSigmas::make(field, kFrame, numbers(10), covariance_of(each), {}).value();
  struct Place {
    int x, y;
    Vec3 normal;
  };
  const std::vector<Place> places = {
      {200, 130, {0, 0, 1}}, {8, 12, tilted(15, 70)}, {391, 200, tilted(10, 200)}};
  constexpr int kRigs = 1000;
  std::vector<double> across(places.size()), along(places.size());
  test::Random random(7);
  for (int rig = 0; rig < kRigs; ++rig) {
    NearLights perturbed = lights;
    for (NearLight& led : perturbed.leds) {
      std::vector<double> d;
      for (const double sigma : each.sigmas) d.push_back(sigma * random.normal());
      led.position_mm = led.position_mm + Vec3{d[0], d[1], d[2]};
      led.aim = normalized(led.aim + Vec3{d[3], d[4], 0});
      led.mu += d[5];
      for (double& flux : led.flux_rgb) flux *= std::exp(d[6]);
      led.log_gain_quadratic[1] += d[7];
    }
    const LightField assumed = field_of(perturbed);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto& [x, y, n] = places[i];
      const Vec3 error = solved(field, assumed, x, y, n, 0.5) - 0.5 * n;
      const double radial = dot(error, n);
      across[i] += dot(error, error) - radial * radial;
      along[i] += radial * radial;
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& [x, y, n] = places[i];
    const CalibrationSigma sigma = sigmas.at(x, y, 1, n, 0.5);
    const double seen_deg = degrees(std::sqrt(across[i] / kRigs) / 0.5),
                 seen = std::sqrt(along[i] / kRigs) / 0.5;
    EXPECT_NEAR(sigma.normal_deg / seen_deg, 1, 0.06) << seen_deg << " degrees seen at place " << i;
    EXPECT_NEAR(sigma.relative_albedo / seen, 1, 0.06) << seen << " seen at place " << i;
  }
}

TEST(CalibrationSigma, OfALightIsWhatAPerturbedRigShows) {
  const NearLights lights = test::ten_leds(1.3);
  const LightField field = field_of(lights);
  constexpr int kX = 320, kY = 40;
  constexpr std::size_t kLed = 3, kErrors = 4, kAll = 10 * kErrors;
  struct Parameter {
    std::string name;
    double change;
    std::function<void(NearLight&, double)> apply;
  };
  const std::vector<Parameter> parameters = {
      {"position_mm.x", 0.01, [](NearLight& led, double d) { led.position_mm.x += d; }},
      {"position_mm.y", 0.01, [](NearLight& led, double d) { led.position_mm.y += d; }},
      {"position_mm.z", 0.01, [](NearLight& led, double d) { led.position_mm.z += d; }},
      {"mu", 1e-4, [](NearLight& led, double d) { led.mu += d; }},
      {"log_flux", 1e-4, [](NearLight& led, double d) { led.flux_rgb[0] *= std::exp(d); }}};
  for (const Parameter& parameter : parameters) {
    NearLights perturbed = lights;
    parameter.apply(perturbed.leds[kLed], parameter.change);
    const LightField::Light was = field.at(kLed, 0, kX, kY), is = field_of(perturbed).at(kLed, 0, kX, kY);
    const Vec3 turn = is.direction - was.direction;
    const std::array<double, kErrors> seen = {std::log(is.strength / was.strength), turn.x, turn.y, turn.z};
    const std::vector<double> covariance =
        CalibrationSigmas::make(field, kFrame, numbers(10),
                                covariance_of({{parameter.name}, {parameter.change}}), {})
            .value()
            .light_errors_at(kX, kY);
    ASSERT_EQ(covariance.size(), kAll * kAll);
    for (std::size_t i = 0; i < kErrors; ++i) {
      for (std::size_t j = 0; j < kErrors; ++j) {
        const double truth = seen[i] * seen[j];
        EXPECT_NEAR(covariance[(kErrors * kLed + i) * kAll + kErrors * kLed + j], truth,
                    0.02 * std::abs(truth) + 1e-13)
            << parameter.name << " " << i << " " << j;
      }
    }
    // Other LEDs are independent of it.
    EXPECT_EQ(covariance[kErrors * kLed * kAll], 0) << parameter.name;
  }
}

TEST(CalibrationSigma, OfACommonFluxErrorIsAllAlbedo) {
  const LightField field = field_of(test::ten_leds());
  ParameterCovariance common = covariance_of({{"log_flux"}, {0.02}});
  std::fill(common.matrix.begin(), common.matrix.end(), 0.02 * 0.02);
  const CalibrationSigma sigma = CalibrationSigmas::make(field, kFrame, numbers(10), common, {})
                                     .value()
                                     .at(90, 40, 0, tilted(20, 30), 0.3);
  EXPECT_NEAR(sigma.relative_albedo, 0.02, 1e-12);
  EXPECT_LT(sigma.normal_deg, 1e-6);
}

TEST(CalibrationSigma, TakesTheParametersOfTheLedsThatAreLitAlone) {
  const std::vector<int> lit = {2, 5, 7, 9};
  const LightField field = LightField::make(select_lights(Lights(test::ten_leds()), lit).value(),
                                            overhead_camera(kFrame, 600, 0.5), kFrame, 0)
                               .value();
  ParameterCovariance of_led_five = covariance_of({{"log_flux"}, {0}});
  of_led_five.matrix[4 * 10 + 4] = 1e-4;
  const auto at = [&](const ParameterCovariance& c) {
    return CalibrationSigmas::make(field, kFrame, lit, c, {})
        .value()
        .at(200, 130, 1, {0, 0, 1}, 0.5)
        .normal_deg;
  };
  EXPECT_GT(at(of_led_five), 0.1);
  ParameterCovariance of_led_four = covariance_of({{"log_flux"}, {0}});
  of_led_four.matrix[3 * 10 + 3] = 1e-4;
  EXPECT_EQ(at(of_led_four), 0);
}

TEST(CalibrationSigma, IsUnknownWhereTooFewLedsFaceThePixel) {
  const LightField field = field_of(test::ten_leds());
  const CalibrationSigmas sigmas =
      CalibrationSigmas::make(field, kFrame, numbers(10), position_covariance(1), NoiseModel{1e-5, 1e-8, 0})
          .value();
  for (const Vec3 n : {Vec3{0, 0, -1}, Vec3{std::nan(""), 0, 1}}) {
    EXPECT_EQ(sigmas.at(10, 10, 1, n, 0.5).normal_deg, 180);
    EXPECT_EQ(sigmas.at(10, 10, 1, n, 0.5).relative_albedo, 1);
  }
  const CalibrationSigma black = sigmas.at(10, 10, 1, {0, 0, 1}, 0);
  EXPECT_TRUE(std::isfinite(black.normal_deg) && std::isfinite(black.relative_albedo));
}

TEST(CalibrationSigma, RefusesNamesItDoesNotKnowAndDistantLights) {
  const LightField field = field_of(test::ten_leds());
  for (const char* name : {"led01.position_mm.w", "led01", "led.mu", "led00.mu", "camera.fx", "led01.mu.x",
                           "led01.log_gain_quadratic.6", ""}) {
    const auto made = CalibrationSigmas::make(field, kFrame, numbers(10), {{name}, {1}}, {});
    ASSERT_FALSE(made) << name;
    EXPECT_EQ(made.error().kind, ErrorKind::kBadData);
    EXPECT_EQ(made.error().where, name);
  }
  const LightField distant = LightField::make(DistantLights{{{{0, 0, 1}, {1, 1, 1}},
                                                             {normalized({1, 0, 1}), {1, 1, 1}},
                                                             {normalized({0, 1, 1}), {1, 1, 1}}}},
                                              {}, kFrame, 0)
                                 .value();
  const auto made = CalibrationSigmas::make(distant, kFrame, numbers(3), {{"led01.mu"}, {1}}, {});
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().message(), testing::HasSubstr("distant"));
}

}  // namespace
}  // namespace weft::solver
