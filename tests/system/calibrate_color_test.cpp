// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibrate_color.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "calibration/color/chart.h"
#include "calibration/color/color_fit.h"
#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "core/rig/color_transform.h"
#include "simulator/simulate.h"
#include "simulator/spectra/observer.h"
#include "solve/run/solve_session.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::contents_of;
using test::Workspace;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kPitch_px = 44, kSide_px = kPitch_px * calibration::kPatchShare;
constexpr int kLeft = 40, kTop = 40;
const std::vector<double> kCorners = {kLeft - 0.5,
                                      kTop - 0.5,
                                      kLeft - 0.5 + 5 * kPitch_px + kSide_px,
                                      kTop - 0.5,
                                      kLeft - 0.5 + 5 * kPitch_px + kSide_px,
                                      kTop - 0.5 + 3 * kPitch_px + kSide_px,
                                      kLeft - 0.5,
                                      kTop - 0.5 + 3 * kPitch_px + kSide_px};

// A photograph of the published chart by a camera that a matrix describes, as a 16-bit TIFF.
struct Photograph {
  double exposure = 0.8;
  double slope = 0.1;  // of the light, from left to right
  double shadow = 1;   // of the light on the left third
  bool upside_down = false, mirrored = false;

  void write(const fs::path& file) const {
    const calibration::ChartReference chart = calibration::published_chart();
    Image<float> rgb({340, 250}, 3);
    for (int y = 0; y < rgb.height(); ++y) {
      for (int x = 0; x < rgb.width(); ++x) {
        const int i = static_cast<int>(std::floor((x - kLeft) / kPitch_px)),
                  j = static_cast<int>(std::floor((y - kTop) / kPitch_px));
        const bool inside = x >= kLeft && y >= kTop && i < 6 && j < 4 &&
                            x - kLeft - i * kPitch_px < kSide_px && y - kTop - j * kPitch_px < kSide_px;
        const int column = upside_down || mirrored ? 5 - i : i, row = upside_down ? 3 - j : j;
        const Rgb seen = inside ? chart[static_cast<std::size_t>(6 * row + column)] : Rgb{0.02, 0.02, 0.02};
        const double light = exposure * (1 + slope * (x / 340.0 - 0.5)) * (x < 115 ? shadow : 1.0);
        const Mat3 camera = {{{0.44, 0.13, 0.03}, {0.1, 0.8, 0.1}, {0.02, 0.12, 0.56}}};
        const Vec3 v = camera * Vec3{seen[0], seen[1], seen[2]};
        for (int c = 0; c < 3; ++c) {
          const double value = light * (c == 0 ? v.x : c == 1 ? v.y : v.z);
          rgb(x, y, c) = static_cast<float>(std::clamp(value, 0.0, 1.0));
        }
      }
    }
    const std::array<View<const float>, 3> planes = {rgb.plane(0), rgb.plane(1), rgb.plane(2)};
    const auto written = write_image(file, planes, {"R", "G", "B"}, {.type = SampleType::kUint16});
    ASSERT_TRUE(written) << written.error().message();
  }
};

calibration::CalibrateColorOptions options_of(const Workspace& work) {
  calibration::CalibrateColorOptions options;
  options.input = work / "color";
  options.output = work / "new";
  options.rig = "rig A";
  options.corners_px = kCorners;
  return options;
}

std::string refusal(const Workspace& work, const calibration::CalibrateColorOptions& options) {
  const auto before = contents_of(work.path());
  const auto outcome = calibration::calibrate_color(options, {});
  EXPECT_EQ(contents_of(work.path()), before) << "nothing is written";
  return outcome ? "accepted" : outcome.error().message();
}

std::string refusal_of(const Photograph& photograph) {
  const Workspace work;
  fs::create_directories(work / "color");
  photograph.write(work / "color" / "chart.tif");
  return refusal(work, options_of(work));
}

TEST(CalibrateColor, FitsAPhotographUnderALampToOneSide) {
  const Workspace work;
  fs::create_directories(work / "color");
  Photograph().write(work / "color" / "chart.tif");
  const auto outcome = calibration::calibrate_color(options_of(work), {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_THAT(outcome->report.verdicts, IsEmpty());
  EXPECT_LT(outcome->report.numbers["mean_held_out"].get<double>(), 0.5);
  EXPECT_GT(outcome->report.numbers["mean_before"].get<double>(), 4);
  EXPECT_NEAR(outcome->report.numbers["slope_of_light"].get<double>(), 0.08, 0.04);
  EXPECT_EQ(outcome->report.numbers["sources"], Json::array({"chart.tif"})) << "not where it lay";
  const auto read = read_calibration(work / "new");
  ASSERT_TRUE(read) << read.error().message();
  for (const auto& row : read->color->rec709_from_camera) EXPECT_NEAR(row[0] + row[1] + row[2], 1, 1e-12);
  EXPECT_EQ(read->color->covariance.size(), 81U);
  EXPECT_FALSE(read->color->curve);
  const std::string page = bytes_of(work / "new" / "report" / "color.html");
  EXPECT_THAT(page, HasSubstr("purplish blue"));
  EXPECT_THAT(page, HasSubstr("\\u003csvg"));
}

TEST(CalibrateColor, WritesTheCurveWhereItIsAskedFor) {
  const Workspace work;
  fs::create_directories(work / "color");
  Photograph().write(work / "color" / "chart.tif");
  calibration::CalibrateColorOptions options = options_of(work);
  options.curve = true;
  const auto outcome = calibration::calibrate_color(options, {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_TRUE(read_calibration(work / "new")->color->curve);
  EXPECT_LT(outcome->report.numbers["mean_by_curve"].get<double>(), 3);
}

TEST(CalibrateColor, NamesAChartThatIsUpsideDownOrMirrored) {
  Photograph photograph;
  photograph.upside_down = true;
  EXPECT_THAT(refusal_of(photograph), HasSubstr("upside down"));
  photograph = {};
  photograph.mirrored = true;
  EXPECT_THAT(refusal_of(photograph), HasSubstr("mirrored"));
}

TEST(CalibrateColor, ReadsAChartThatWasFoundUpsideDown) {
  const Workspace work;
  fs::create_directories(work / "color");
  Photograph photograph;
  photograph.upside_down = true;
  photograph.write(work / "color" / "chart.tif");
  calibration::CalibrateColorOptions options = options_of(work);
  options.corners_px.clear();
  const auto outcome = calibration::calibrate_color(options, {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  ASSERT_THAT(outcome->warnings, SizeIs(1));
  EXPECT_THAT(outcome->warnings[0], HasSubstr("upside down"));
  EXPECT_LT(outcome->report.numbers["mean_held_out"].get<double>(), 0.5);
}

TEST(CalibrateColor, NamesPatchesInShadow) {
  Photograph photograph;
  photograph.shadow = 0.5;
  const std::string message = refusal_of(photograph);
  EXPECT_THAT(message, HasSubstr("in shadow"));
  EXPECT_THAT(message, HasSubstr("1 (dark skin)"));
  EXPECT_THAT(message, HasSubstr("chart.tif"));
}

TEST(CalibrateColor, LeavesFullPatchesOutAndRefusesTooMany) {
  const Workspace work;
  fs::create_directories(work / "color");
  Photograph photograph;
  photograph.exposure = 1.15;
  photograph.write(work / "color" / "chart.tif");
  const auto outcome = calibration::calibrate_color(options_of(work), {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  ASSERT_THAT(outcome->report.verdicts, SizeIs(1));
  EXPECT_THAT(outcome->report.verdicts[0].text, HasSubstr("patches 19 (white) are full"));
  EXPECT_THAT(outcome->report.numbers["patches"], SizeIs(23));
  EXPECT_LT(outcome->report.numbers["mean_held_out"].get<double>(), 0.5);
  photograph.exposure = 4;
  EXPECT_THAT(refusal_of(photograph), HasSubstr("too many patches are full"));
}

TEST(CalibrateColor, WarnsOfLightThatFallsOffAndOfAChartThatIsDark) {
  const Workspace work;
  fs::create_directories(work / "color");
  Photograph photograph;
  photograph.slope = 0.8;
  photograph.exposure = 0.02;
  photograph.write(work / "color" / "chart.tif");
  const auto outcome = calibration::calibrate_color(options_of(work), {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  std::vector<std::string> names;
  for (const Verdict& v : outcome->report.verdicts) names.push_back(v.name);
  EXPECT_THAT(names, testing::ElementsAre("CHART_DARK", "CHART_UNEVENLY_LIT"));
}

TEST(CalibrateColor, RefusesWhatIsNoChartAndNoPicture) {
  const Workspace work;
  EXPECT_THAT(refusal(work, options_of(work)), HasSubstr("no picture of a chart"));
  fs::create_directories(work / "color");
  Photograph().write(work / "color" / "chart.tif");
  calibration::CalibrateColorOptions options = options_of(work);
  for (std::size_t i = 0; i < 8; i += 2) options.corners_px[i] = options.corners_px[i] / 4 + 150;
  EXPECT_THAT(refusal(work, options), HasSubstr("not the chart"));
  ASSERT_TRUE(write_file(work / "color" / "chart.toml", "srgb = [[1, 2, 3]]\n"));
  EXPECT_THAT(refusal(work, options_of(work)), HasSubstr("must be 24 lists"));
  ASSERT_TRUE(write_file(work / "color" / "chart.toml", "edition = \"1976\"\n"));
  EXPECT_THAT(refusal(work, options_of(work)), HasSubstr("must be one of 2014, before 2014"));
  fs::remove(work / "color" / "chart.toml");
  test::put_bytes(work / "color" / "b.dng", "II*");
  EXPECT_THAT(refusal(work, options_of(work)), HasSubstr("b.dng"));
}

TEST(CalibrateColor, TakesTheEditionOfTheChartThatIsNamed) {
  const Workspace work;
  fs::create_directories(work / "color");
  Photograph().write(work / "color" / "chart.tif");
  ASSERT_TRUE(write_file(work / "color" / "chart.toml", "edition = \"before 2014\"\n"));
  const auto outcome = calibration::calibrate_color(options_of(work), {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_THAT(outcome->report.numbers["reference"].get<std::string>(), HasSubstr("before November 2014"));
  EXPECT_GT(outcome->report.numbers["mean_after"].get<double>(), 0.5) << "the photograph is of a newer one";
}

// A session of the simulated chart, its true colours in chart.toml.
void simulate_chart(const fs::path& folder) {
  simulator::Scene scene = test::scene_named("chart", {308, 204});
  scene.camera.mm_per_pixel = 0.7;
  scene.lights.rings = {{3, 40, 0, 600}};
  scene.effects.noise = false;
  simulator::TargetSettings chart;
  chart.pattern = simulator::ChartSettings{};
  chart.centre_mm.z = 0;
  scene.targets = {chart};
  test::simulate(scene, folder / "chart.weft");
  std::string toml = "rec709 = [";
  for (const simulator::Spectrum& patch : scene.spectra.chart) {
    const Rgb rgb = simulator::rec709_albedo(patch);
    toml += fmt::format("[{}, {}, {}], ", rgb[0], rgb[1], rgb[2]);
  }
  ASSERT_TRUE(write_file(folder / "chart.toml", toml + "]\n"));
}

Result<solve::SolveReport> solve(const fs::path& session, const fs::path& calibration,
                                 const fs::path& output) {
  solve::SessionOptions input;
  input.folder = session;
  input.calibration = calibration;
  solve::SolveOptions options;
  options.method = "fast";
  options.output = output;
  options.previews = false;
  return solve::solve_session(input, options, {});
}

Rgb at(const LoadedImage& image, int x, int y) {
  return {static_cast<double>(image.planes(x, y, 0)), static_cast<double>(image.planes(x, y, 1)),
          static_cast<double>(image.planes(x, y, 2))};
}

/// The matrix's own share is a channel of its own, and that of noise went through the matrix.
void expect_sigma(const ColorTransform& transform, const LoadedImage& camera, const LoadedImage& plain,
                  const LoadedImage& sigma) {
  const View<const float> share = sigma.channel("R.calibration");
  ASSERT_FALSE(share.empty());
  EXPECT_TRUE(plain.channel("R.calibration").empty());
  EXPECT_TRUE(sigma.channel("normal_deg.calibration").empty()) << "nothing is known of the lights";
  const int x = 150, y = 100;
  const Rgb a = at(camera, x, y);
  constexpr std::array<const char*, 3> kNoise = {"R.noise", "G.noise", "B.noise"};
  double variance = 0, noise = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    noise +=
        std::pow(transform.rec709_from_camera[0][i] * static_cast<double>(plain.channel(kNoise[i])(x, y)), 2);
    for (std::size_t j = 0; j < 3; ++j) variance += a[i] * a[j] * transform.covariance[9 * i + j];
  }
  EXPECT_NEAR(static_cast<double>(share(x, y)), std::sqrt(variance), 0.01 * std::sqrt(variance));
  EXPECT_NEAR(static_cast<double>(sigma.channel("R.noise")(x, y)), std::sqrt(noise), 0.01 * std::sqrt(noise));
}

TEST(CalibrateColor, MakesSolvedAlbedoRec709) {
  const Workspace work;
  fs::create_directories(work / "color");
  simulate_chart(work / "color");
  const fs::path session = work / "color" / "chart.weft";
  calibration::CalibrateColorOptions options = options_of(work);
  options.from = session / "calibration";
  options.corners_px.clear();
  const auto outcome = calibration::calibrate_color(options, {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  EXPECT_LT(outcome->report.numbers["mean_held_out"].get<double>(), 1.5);
  EXPECT_NEAR(outcome->report.numbers["chart_over_albedo"].get<double>(), 1, 0.03);

  Calibration without_color = outcome->calibration;
  without_color.color.reset();
  ASSERT_TRUE(write_calibration(work / "camera", without_color));
  const auto before = solve(session, work / "camera", work / "before"),
             after = solve(session, work / "new", work / "after");
  ASSERT_TRUE(before && after);
  EXPECT_FALSE(before->facts.is_rec709);
  EXPECT_TRUE(after->facts.is_rec709);
  EXPECT_NE(before->facts.id, after->facts.id);
  EXPECT_EQ(bytes_of(work / "before" / "normal.exr"), bytes_of(work / "after" / "normal.exr"));

  const auto camera = read_image(work / "before" / "albedo.exr"),
             rec709 = read_image(work / "after" / "albedo.exr"),
             truth = read_image(session / "truth" / "albedo.exr"),
             sigma = read_image(work / "after" / "sigma.exr"),
             plain = read_image(work / "before" / "sigma.exr");
  ASSERT_TRUE(camera && rec709 && truth && sigma && plain);
  const ColorTransform& transform = *outcome->calibration.color;
  double worst = 0, off_before = 0, off_after = 0;
  bool below_nothing = false;
  for (int y = 60; y < 150; y += 3) {
    for (int x = 60; x < 250; x += 3) {
      const Rgb expected = rec709_of_camera(transform, at(*camera, x, y));
      for (std::size_t c = 0; c < 3; ++c) {
        worst = std::max(worst, std::abs(expected[c] - at(*rec709, x, y)[c]));
        below_nothing = below_nothing || at(*rec709, x, y)[c] < 0;
      }
      off_before += calibration::ciede2000_of(at(*camera, x, y), at(*truth, x, y));
      off_after += calibration::ciede2000_of(at(*rec709, x, y), at(*truth, x, y));
    }
  }
  EXPECT_LT(worst, 2e-3) << "half floats";
  EXPECT_TRUE(below_nothing) << "cyan is outside Rec.709, and stays so";
  EXPECT_LT(off_after, 0.6 * off_before);

  expect_sigma(transform, *camera, *plain, *sigma);
}

TEST(CalibrateColor, TakesWhiteAndScaleFromTheChartWhereNobodyMeasuredThem) {
  const Workspace work;
  fs::create_directories(work / "color");
  simulate_chart(work / "color");
  const fs::path session = work / "color" / "chart.weft";
  const Calibration exact = *read_calibration(session / "calibration");
  Calibration tinted = exact;
  tinted.subject.albedo_scale = AlbedoScale::kRelative;
  for (NearLight& led : std::get<NearLights>(*tinted.lights).leds) {
    for (double& flux : led.flux_rgb) flux *= 0.7;
    led.flux_rgb[0] *= 1.05;
  }
  tinted.patches = {{{{10, 10}, {30, 10}, {30, 30}}, {0.8, 0.8, 0.8}}};
  ASSERT_TRUE(write_calibration(work / "tinted", tinted));
  calibration::CalibrateColorOptions options = options_of(work);
  options.from = work / "tinted";
  options.corners_px.clear();
  const auto outcome = calibration::calibrate_color(options, {});
  ASSERT_TRUE(outcome) << outcome.error().message();
  const Calibration& now = outcome->calibration;
  EXPECT_EQ(now.subject.albedo_scale, AlbedoScale::kAbsolute);
  const auto& flux = std::get<NearLights>(*now.lights).leds[1].flux_rgb;
  const auto& truth = std::get<NearLights>(*exact.lights).leds[1].flux_rgb;
  EXPECT_NEAR(flux[1] / truth[1], 1, 0.03) << "the scale";
  EXPECT_NEAR(flux[0] / flux[1] / (truth[0] / truth[1]), 1, 0.01) << "red over green";
  EXPECT_NEAR(flux[2] / flux[1] / (truth[2] / truth[1]), 1, 0.01) << "blue over green";
  ASSERT_THAT(now.patches, SizeIs(1));
  EXPECT_NEAR(now.patches[0].reflectance_rgb[1] * flux[1],
              0.8 * std::get<NearLights>(*tinted.lights).leds[1].flux_rgb[1], 1e-6 * flux[1])
      << "a patch sends back what it did";

  options.from = session / "calibration";
  options.output = work / "absolute";
  const auto absolute = calibration::calibrate_color(options, {});
  ASSERT_TRUE(absolute) << absolute.error().message();
  EXPECT_NEAR(std::get<NearLights>(*absolute->calibration.lights).leds[1].flux_rgb[1], truth[1],
              1e-6 * truth[1])
      << "a reflectance that was measured is kept";
}

}  // namespace
}  // namespace weft::app
