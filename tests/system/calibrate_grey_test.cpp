// SPDX-License-Identifier: Apache-2.0
// From a scan of a grey scale to the brightness and white balance of each LED.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "calibration/run/calibrate_grey.h"
#include "core/base/files.h"
#include "simulator/scene/scene_rig.h"
#include "simulator/simulate.h"
#include "tests/system/workspace.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using simulator::Scene;
using test::contents_of;
using test::Workspace;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kPatch_mm = 18, kGap_mm = 2, kThickness_mm = 1.5;

/// 600 x 400 pixels over 200 mm of table, LEDs of different brightness and colour, and a Munsell scale.
Scene rig_scene() {
  Scene scene;
  scene.camera.width = 600;
  scene.camera.height = 400;
  scene.camera.mm_per_pixel = 200.0 / 600;
  scene.material.albedo.fill(0.2);
  scene.effects.near_light = scene.effects.noise = true;
  const NearLights lights = simulator::rig_of(scene)->leds;
  double k = 0;
  for (const NearLight& led : lights.leds) {
    const std::array<double, 3> flux = {led.flux_rgb[0] * (0.6 + 0.02 * k), led.flux_rgb[1] * (1 - 0.03 * k),
                                        led.flux_rgb[2] * (0.7 - 0.01 * k)};
    scene.lights.leds.push_back({led.position_mm, led.aim, led.mu, flux});
    ++k;
  }
  simulator::TargetSettings& scale = scene.targets.emplace_back();
  simulator::GreyScaleSettings greys;
  greys.patch_mm = kPatch_mm;
  greys.gap_mm = kGap_mm;
  scale.pattern = greys;
  scale.centre_mm.z = kThickness_mm;
  return scene;
}

std::string scale_file(const Scene& scene) {
  const simulator::GreyScaleSettings greys;
  const auto count = static_cast<double>(greys.reflectances.size());
  const double u = (count * kPatch_mm + (count - 1) * kGap_mm) / 2, v = kPatch_mm / 2;
  const CameraModel camera = simulator::rig_of(scene)->camera;
  std::string corners;
  for (const auto& [x, y] : {std::pair{-u, v}, {u, v}, {u, -v}, {-u, -v}}) {
    const Vec3 p = project(camera, {x, y, kThickness_mm});
    corners += fmt::format("{}[{:.2f}, {:.2f}]", corners.empty() ? "" : ", ", p.x, p.y);
  }
  return fmt::format("reflectances = [{}]\ncorners_px = [{}]\nheight_mm = {}\n",
                     fmt::join(greys.reflectances, ", "), corners, kThickness_mm);
}

/// A session of the scale, and what is known of the rig before: where its LEDs are, not how bright.
class CalibrateGrey : public testing::Test {
 protected:
  void simulate(const Scene& scene) {
    simulator::SimulateOptions options;
    options.truth = false;
    const auto session = simulator::simulate_session(scene, work_ / "grey.weft", options);
    ASSERT_TRUE(session) << session.error().message();
    ASSERT_TRUE(write_file(work_ / "scale.toml", scale_file(scene)));
    const auto exact = read_calibration(work_ / "grey.weft" / "calibration");
    ASSERT_TRUE(exact) << exact.error().message();
    exact_ = *exact;
    Calibration before = exact_;
    before.subject.albedo_scale = AlbedoScale::kRelative;
    NearLights& lights = std::get<NearLights>(*before.lights);
    for (NearLight& led : lights.leds) led.flux_rgb = {1, 1, 1};
    before.patches = {{{{{1, 1}}, {{30, 1}}, {{30, 30}}}, {0.9, 0.9, 0.9}}};
    before.response->linearity = {};
    before.light_covariance = ParameterCovariance{{"led01.position_mm.x", "led01.log_flux"}, {1, 0, 0, 1e-6}};
    ASSERT_TRUE(write_calibration(work_ / "before", before));
  }
  Result<calibration::CalibrateOutcome> calibrate() const {
    return calibration::calibrate_grey(
        {.session = work_ / "grey.weft", .from = work_ / "before", .output = work_ / "after"}, {});
  }
  std::string refusal() const {
    const auto contents = contents_of(work_.path());
    const auto outcome = calibrate();
    EXPECT_EQ(contents_of(work_.path()), contents) << "nothing is written";
    return outcome ? "accepted" : outcome.error().message();
  }

  Workspace work_;
  Calibration exact_;
};

TEST_F(CalibrateGrey, TellsFluxAndWhiteBalanceOfEachLedWithinTheirSigma) {
  ASSERT_NO_FATAL_FAILURE(simulate(rig_scene()));
  const auto outcome = calibrate();
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_THAT(outcome->report.verdicts, IsEmpty()) << outcome->report.verdicts.front().text;
  const NearLights& truth = std::get<NearLights>(*exact_.lights);
  const Json& leds = outcome->report.numbers["leds"];
  ASSERT_EQ(leds.size(), truth.leds.size());
  double worst = 0, worst_balance = 0;
  for (std::size_t k = 0; k < truth.leds.size(); ++k) {
    const auto& flux = truth.leds[k].flux_rgb;
    for (std::size_t c = 0; c < 3; ++c) {
      const double off = leds[k]["flux_rgb"][c].get<double>() / flux[c] - 1;
      EXPECT_LT(std::abs(off), 3 * leds[k]["relative_sigma"][c].get<double>()) << "LED " << k + 1;
      worst = std::max(worst, std::abs(off));
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const double off = leds[k]["balance"][i].get<double>() / (flux[2 * i] / flux[1]) - 1;
      EXPECT_LT(std::abs(off), 3 * leds[k]["balance_relative_sigma"][i].get<double>()) << "LED " << k + 1;
      worst_balance = std::max(worst_balance, std::abs(off));
    }
  }
  EXPECT_LT(worst, 0.01);
  EXPECT_LT(worst_balance, 0.004);

  const auto after = read_calibration(work_ / "after");
  ASSERT_TRUE(after) << after.error().message();
  EXPECT_EQ(after->subject.albedo_scale, AlbedoScale::kAbsolute);
  EXPECT_THAT(after->patches, IsEmpty());
  EXPECT_THAT(outcome->warnings, SizeIs(1)) << "the white patches are left out";
  const auto& found = std::get<NearLights>(*after->lights).leds[2];
  EXPECT_EQ(found.flux_rgb[0], leds[2]["flux_rgb"][0].get<double>());
  EXPECT_EQ(found.position_mm, truth.leds[2].position_mm);
  const std::vector<double>& covariance = after->light_covariance->matrix;
  EXPECT_EQ(covariance[0], 1) << "of the place";
  EXPECT_GT(covariance[3], 1e-6 + 1e-6) << "of the flux";
  EXPECT_TRUE(is_there(work_ / "after" / "report" / "grey.html"));
}

TEST_F(CalibrateGrey, SeesAResponseThatTheCalibrationTakesForStraight) {
  Scene scene = rig_scene();
  scene.effects.nonlinearity = true;
  scene.camera.linearity = {0.1, 0};
  ASSERT_NO_FATAL_FAILURE(simulate(scene));
  const auto outcome = calibrate();
  ASSERT_TRUE(outcome) << outcome.error().message();
  ASSERT_THAT(outcome->report.verdicts, testing::Not(IsEmpty()));
  EXPECT_EQ(outcome->report.verdicts.back().name, "RESPONSE_BENT");
  const double sigma = outcome->report.numbers["sigma_bend"].get<double>();
  EXPECT_NEAR(outcome->report.numbers["bend"].get<double>(), 0.1, 0.01 + 3 * sigma);
}

TEST_F(CalibrateGrey, RefusesAScaleThatIsNowhereOrBlack) {
  ASSERT_NO_FATAL_FAILURE(simulate(rig_scene()));
  ASSERT_TRUE(write_file(work_ / "scale.toml", "height_mm = 1\n"));
  EXPECT_THAT(refusal(), HasSubstr("it has no corners_px"));
  ASSERT_TRUE(write_file(work_ / "scale.toml", "corners_px = [[0, 0], [601, 0], [600, 9], [0, 9]]\n"));
  EXPECT_THAT(refusal(), HasSubstr("corner (601, 0) is outside the frame"));
  ASSERT_TRUE(write_file(work_ / "scale.toml", "reflectances = [0.9, 0.5, 0.3, 0.1, 0]\n"));
  EXPECT_THAT(refusal(), HasSubstr("above 0"));
}

}  // namespace
}  // namespace weft::app
