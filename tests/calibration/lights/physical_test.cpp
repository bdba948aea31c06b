// SPDX-License-Identifier: Apache-2.0
#include "calibration/lights/physical.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bench/oracles/paper_oracle.h"

namespace weft::calibration {
namespace {

using test::PaperCaptures;
using test::PaperErrors;
using test::PaperRig;
using testing::HasSubstr;

// Fewer blocks than a real frame gives, with as much less noise, so that a fit is a matter of tenths of a
// second.
PaperCaptures small_captures(const PaperRig& rig, PaperErrors errors = {}) {
  errors.noise *= 0.5;
  return test::captures_of(rig, errors, 13, 8);
}

LightFit fitted(const PaperCaptures& captures, const LightFitOptions& options = {}) {
  Result<LightFit> fit = fit_lights(captures.start, captures.readings, options);
  EXPECT_TRUE(fit) << fit.error().message();
  return fit ? std::move(*fit) : LightFit();
}

// A rig whose LEDs have gains of their own, and what is found of it; the same for several tests.
PaperRig rig_with_gains() {
  PaperRig rig = test::common_rig();
  test::give_gains(rig.lights, 0.005);
  return rig;
}
const LightFit& fit_with_gains() {
  static const LightFit fit = fitted(small_captures(rig_with_gains()));
  return fit;
}

TEST(PhysicalLights, AreFoundFromFivePosesAndATapeTenMillimetresWrong) {
  const PaperRig rig = test::common_rig();
  const LightFit fit = fitted(small_captures(rig));
  EXPECT_LT(test::position_error_mm(fit.scene.lights, rig.lights), 0.5);
  EXPECT_LT(test::direction_error_deg(fit.scene.lights, rig.lights), 0.05);
  EXPECT_LE(fit.iterations, 15);
  EXPECT_GT(fit.chi_square, 0.9);
  EXPECT_LT(fit.chi_square, 1.1);
  EXPECT_FALSE(fit.is_weak()) << fit.worst_position_sigma_mm();
  EXPECT_LT(fit.flicker, 0.0005) << "there is none";
}

TEST(PhysicalLights, AreFoundOnPaperThatIsNotLambertian) {
  PaperRig rig = test::common_rig();
  rig.delta = 0.05;
  const PaperCaptures captures = small_captures(rig);
  const LightFit fit = fitted(captures);
  EXPECT_NEAR(fit.scene.paper.delta, 0.05, 0.01);
  EXPECT_LT(test::position_error_mm(fit.scene.lights, rig.lights), 0.5);
  EXPECT_LT(test::direction_error_deg(fit.scene.lights, rig.lights), 0.05);
  EXPECT_FALSE(fit.misfits()) << fit.chi_square;

  LightFitOptions locked;
  locked.lambertian = true;
  locked.most_iterations = 8;  // it crawls along a valley that has no good place
  const LightFit wrong = fitted(captures, locked);
  EXPECT_EQ(wrong.scene.paper.delta, 0);
  EXPECT_TRUE(wrong.misfits()) << "chi-square is " << wrong.chi_square;
}

TEST(PhysicalLights, ErrBySoMuchAsTheirCovarianceSays) {
  const PaperRig rig = test::common_rig();
  double normalised = 0, count = 0;
  for (const std::uint64_t seed : {1u, 2u}) {
    PaperErrors errors;
    errors.seed = seed;
    const LightFit fit = fitted(small_captures(rig, errors));
    for (std::size_t k = 0; k < rig.lights.leds.size(); ++k) {
      const Vec3 off = fit.scene.lights.leds[k].position_mm - rig.lights.leds[k].position_mm;
      const Vec3 sigma = fit.position_sigma_mm[k];
      normalised +=
          std::pow(off.x / sigma.x, 2) + std::pow(off.y / sigma.y, 2) + std::pow(off.z / sigma.z, 2);
      count += 3;
    }
  }
  EXPECT_GT(normalised / count, 0.5);
  EXPECT_LT(normalised / count, 1.5);
}

TEST(PhysicalLights, BearFlickerAndErrBySoMuchAsTheySay) {
  const PaperRig rig = test::common_rig();
  double normalised = 0, count = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    PaperErrors errors;
    errors.seed = seed;
    errors.flicker = 0.003;
    const LightFit fit = fitted(small_captures(rig, errors));
    EXPECT_FALSE(fit.misfits()) << "chi-square " << fit.chi_square << ", settled " << fit.settled << ", seed "
                                << seed;
    EXPECT_FALSE(fit.leds_have_gains) << "flicker is no gain, seed " << seed;
    EXPECT_NEAR(fit.flicker, 0.003, 0.001) << "seed " << seed;
    for (std::size_t k = 0; k < rig.lights.leds.size(); ++k) {
      const Vec3 off = fit.scene.lights.leds[k].position_mm - rig.lights.leds[k].position_mm;
      const Vec3 sigma = fit.position_sigma_mm[k];
      normalised +=
          std::pow(off.x / sigma.x, 2) + std::pow(off.y / sigma.y, 2) + std::pow(off.z / sigma.z, 2);
      count += 3;
    }
  }
  EXPECT_LT(std::sqrt(normalised / count), 1.5);
  EXPECT_GT(std::sqrt(normalised / count), 0.7);
}

TEST(PhysicalLights, AreRefusedWhereALedWasAnotherInOneShot) {
  for (const double flicker : {0.0, 0.003}) {
    PaperErrors errors;
    errors.flicker = flicker;
    PaperCaptures captures = small_captures(test::common_rig(), errors);
    for (PaperReading& reading : captures.readings) {
      for (double& value : reading.reading_rgb) value *= reading.sheet == 2 && reading.led == 3 ? 1.03 : 1;
    }
    const LightFit fit = fitted(captures);
    EXPECT_TRUE(fit.misfits()) << "flicker " << flicker;
    ASSERT_TRUE(fit.other_shot) << "flicker " << flicker;
    EXPECT_EQ(fit.other_shot->sheet, 2u);
    EXPECT_EQ(fit.other_shot->led, 3u);
    EXPECT_NEAR(fit.other_shot->log_gain, 0.03, 0.01) << "flicker " << flicker;
  }
}

TEST(PhysicalLights, CallNeitherOfTwoShotsTheOtherOne) {
  PaperCaptures captures = small_captures(test::common_rig());
  captures.start.sheets.resize(2);
  std::erase_if(captures.readings, [](const PaperReading& reading) { return reading.sheet >= 2; });
  for (PaperReading& reading : captures.readings) {
    for (double& value : reading.reading_rgb) value *= reading.sheet == 1 && reading.led == 3 ? 1.03 : 1;
  }
  EXPECT_FALSE(fitted(captures).other_shot);
}

TEST(PhysicalLights, HaveTheSameCovarianceWhereverMemoryLies) {
  const PaperCaptures captures = small_captures(test::common_rig());
  const std::vector<double> first = fitted(captures).covariance.matrix;
  ASSERT_FALSE(first.empty());
  // Holes of every small size, so that what the fit holds lies in another order each time.
  std::vector<std::vector<char>> held;
  for (std::size_t turn = 1; turn <= 3; ++turn) {
    for (std::size_t bytes = 16; bytes < 4096; bytes += 16) held.emplace_back(bytes);
    for (std::size_t i = turn % 2; i < held.size(); i += turn + 1) std::vector<char>().swap(held[i]);
    EXPECT_EQ(fitted(captures).covariance.matrix, first) << "turn " << turn;
  }
}

TEST(PhysicalLights, NameTheParametersOfTheirCovarianceAsLightsDo) {
  const LightFit& fit = fit_with_gains();
  const auto& names = fit.covariance.parameters;
  ASSERT_EQ(names.size(), 130u);
  EXPECT_EQ(names[0], "led01.position_mm.x");
  EXPECT_EQ(names[5], "led01.aim.z");
  EXPECT_EQ(names[6], "led01.mu");
  EXPECT_EQ(names[7], "led01.log_flux");
  EXPECT_EQ(names[12], "led01.log_gain_quadratic.5");
  EXPECT_EQ(names.back(), "led10.log_gain_quadratic.5");
  const auto& m = fit.covariance.matrix;
  ASSERT_EQ(m.size(), 130u * 130u);
  EXPECT_NEAR(std::sqrt(m[0]), fit.position_sigma_mm[0].x, 1e-12);
  for (std::size_t i = 0; i < 130; ++i) {
    EXPECT_GE(m[131 * i], 0) << names[i];
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_NEAR(m[130 * i + j], m[130 * j + i], 1e-12) << names[i] << names[j];
  }
  // The aim is a unit vector: it has no error along itself.
  const Vec3 aim = fit.scene.lights.leds[0].aim;
  double along = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      along +=
          std::array{aim.x, aim.y, aim.z}[i] * m[130 * (3 + i) + 3 + j] * std::array{aim.x, aim.y, aim.z}[j];
  }
  EXPECT_NEAR(along, 0, 1e-12);
}

TEST(PhysicalLights, HaveGainsOfTheirOwnWhereReadingsAskForThem) {
  PaperRig rig = test::common_rig();
  const LightFit ideal = fitted(small_captures(rig));
  EXPECT_FALSE(ideal.leds_have_gains);
  EXPECT_EQ(ideal.scene.lights.leds[2].log_gain_quadratic, (std::array<double, 6>{}));
  EXPECT_EQ(ideal.covariance.parameters.size(), 80u);

  rig = rig_with_gains();
  const LightFit& real = fit_with_gains();
  EXPECT_TRUE(real.leds_have_gains);
  EXPECT_FALSE(real.misfits()) << real.chi_square;
  EXPECT_LE(real.iterations, 80) << "it begins at the tape again";
  EXPECT_LT(test::position_error_mm(real.scene.lights, rig.lights), 1.5 * real.worst_position_sigma_mm());
}

TEST(PhysicalLights, ShareAGainWhoseMeanIsNothing) {
  const PaperRig rig = rig_with_gains();
  const LightFit& fit = fit_with_gains();
  const NearLights& found = fit.scene.lights;
  for (std::size_t c = 0; c < 3; ++c) {
    double mean = 0;
    for (int i = 0; i < 100; ++i) {
      for (int j = 0; j < 100; ++j) mean += found.log_gain_rgb[c].at(0.02 * i - 0.99, 0.02 * j - 0.99) / 1e4;
    }
    EXPECT_NEAR(mean, 0, 1e-4);
    const double corner = found.log_gain_rgb[c].at(-1, 1) - found.log_gain_rgb[c].at(0, 0);
    EXPECT_NEAR(corner, rig.vignette, 0.01) << "the vignette";
  }
  for (std::size_t i = 0; i < 6; ++i) {
    double sum = 0;
    for (const NearLight& led : found.leds) sum += led.log_gain_quadratic[i];
    EXPECT_NEAR(sum / 10, 0, 1e-3) << "what all LEDs have in common is the shared gain's";
  }
}

TEST(PhysicalLights, AreAsBrightAsThePaperIsWhite) {
  const PaperRig rig = test::common_rig();
  PaperCaptures captures = small_captures(rig);
  const double relative = fitted(captures).scene.lights.leds[3].flux_rgb[1];
  captures.start.paper.reflectance_rgb = {0.9, 0.8, 0.7};
  const LightFit absolute = fitted(captures);
  EXPECT_NEAR(absolute.scene.lights.leds[3].flux_rgb[1] / relative, 1 / 0.8, 1e-6);
}

TEST(PhysicalLights, AreToldFromPaperByTurnedSheets) {
  // Paper that gets darker by 6 percent to one side: with every sheet the same way round that is taken for
  // light as far as its prior lets it; a sheet turned by half a circle, flat, shows whose it is.
  PaperRig rig = test::common_rig();
  rig.log_albedo = {-0.03, 0, 0, 0, 0};
  rig.sheets = test::lies(5);
  rig.sheets.push_back({0, 0, 180, {}});
  const LightFit fit = fitted(small_captures(rig));
  EXPECT_NEAR(fit.scene.paper.log_albedo[0], -0.03, 0.003);
  EXPECT_LT(test::position_error_mm(fit.scene.lights, rig.lights), 0.5);
}

TEST(PhysicalLights, ArePartlyMovedByASheetThatIsOnlyFlat) {
  PaperRig rig = test::common_rig();
  rig.sheets = test::lies(1);
  const PaperCaptures captures = small_captures(rig);
  const LightFit fit = fitted(captures);
  EXPECT_TRUE(fit.is_weak());
  EXPECT_GT(fit.worst_position_sigma_mm(), 4) << "one sheet cannot know better";
  EXPECT_LT(fit.worst_position_sigma_mm(), 10.1) << "nor worse than the tape";
  EXPECT_LT(test::position_error_mm(fit.scene.lights, rig.lights), 10);
}

TEST(PhysicalLights, IgnoreAFewBadBlocks) {
  const PaperRig rig = test::common_rig();
  PaperCaptures captures = small_captures(rig);
  for (std::size_t i = 0; i < captures.readings.size(); i += 200) {
    for (double& reading : captures.readings[i].reading_rgb) reading *= 0.8;
  }
  const LightFit fit = fitted(captures);
  EXPECT_LT(test::position_error_mm(fit.scene.lights, rig.lights), 0.7);
  EXPECT_TRUE(fit.misfits()) << "half a percent of the blocks at 200 sigma is not to be passed over";
}

TEST(PhysicalLights, KeepTheirPlaceUnderALobeOfNothing) {
  PaperRig rig = test::common_rig();
  for (NearLight& led : rig.lights.leds) led.mu = 0;
  const LightFit fit = fitted(small_captures(rig));
  EXPECT_LT(test::position_error_mm(fit.scene.lights, rig.lights), 0.5);
  for (const NearLight& led : fit.scene.lights.leds) EXPECT_GE(led.mu, 0);
  EXPECT_LE(fit.iterations, 60) << "bounds that hold are no reason to crawl";
}

TEST(PhysicalLights, AreRefusedWhereReadingsAreNone) {
  PaperCaptures captures = small_captures(test::common_rig());
  const auto why = [&](const PaperCaptures& c) {
    const Result<LightFit> fit = fit_lights(c.start, c.readings, {});
    EXPECT_FALSE(fit);
    return fit ? std::string() : fit.error().message();
  };
  PaperCaptures dark = captures;
  dark.readings[17].reading_rgb[2] = 0;
  EXPECT_THAT(why(dark), HasSubstr("LED 1, sheet 1"));
  PaperCaptures nan = captures;
  nan.readings[17].reading_rgb[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(why(nan), HasSubstr("LED 1, sheet 1"));
  PaperCaptures exact = captures;
  exact.readings[17].relative_sigma[0] = 0;
  EXPECT_THAT(why(exact), HasSubstr("relative error of 0"));
  PaperCaptures few = captures;
  std::erase_if(few.readings, [](const PaperReading& r) { return r.led == 4 && r.sheet > 0; });
  std::erase_if(few.readings, [](const PaperReading& r) { return r.led == 4 && r.x_px > 300; });
  EXPECT_THAT(why(few), HasSubstr("LED 5"));
  PaperCaptures behind = captures;
  behind.start.lights.leds[2].position_mm.z = -300;
  EXPECT_THAT(why(behind), HasSubstr("LED 3"));
}

TEST(PhysicalLights, AreRefusedWhereALedIsNotTheOneThatWasMeasured) {
  // The readings of LEDs 1 and 5 exchanged: each is found where the other is, half a metre from its tape.
  PaperCaptures captures = small_captures(test::common_rig());
  for (PaperReading& r : captures.readings) {
    if (r.led == 0 || r.led == 4) r.led = 4 - r.led;
  }
  const Result<LightFit> fit = fit_lights(captures.start, captures.readings, {});
  ASSERT_FALSE(fit) << "chi-square " << fit->chi_square;
  EXPECT_THAT(fit.error().message(), HasSubstr("LED 1"));
  EXPECT_THAT(fit.error().message(), HasSubstr("exchanged"));
}

}  // namespace
}  // namespace weft::calibration
