// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibrate_lights.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "bench/oracles/paper_oracle.h"
#include "calibration/run/check.h"
#include "calibration/run/sheet_captures.h"
#include "calibration/run/sheet_files.h"
#include "capture/raw/decode_raw.h"
#include "capture/rig.h"
#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "simulator/camera/dng_writer.h"
#include "simulator/simulate.h"
#include "tests/system/program.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

constexpr double kTag_mm = 17;

// A sheet larger than the frame with four tags printed where every pose has them in sight.
struct Sheet {
  double tilt_deg = 0, azimuth_deg = 0, rotation_deg = 0;
};
const std::vector<Sheet> kFive = {{}, {20, 0}, {20, 90}, {20, 180}, {20, 270}};
constexpr std::array<std::array<double, 2>, 4> kTags_mm = {{{-70, 38}, {70, 38}, {-70, -38}, {70, -38}}};

Vec3 on_sheet(const Sheet& sheet, double u, double v, double above_mm) {
  const double r = radians(sheet.rotation_deg), a = radians(sheet.azimuth_deg), t = radians(sheet.tilt_deg);
  const double x = std::cos(r) * u - std::sin(r) * v, y = std::sin(r) * u + std::cos(r) * v;
  const double along = x * std::cos(a) + y * std::sin(a), beside = -x * std::sin(a) + y * std::cos(a);
  const double out = along * std::cos(t) + above_mm * std::sin(t);
  return {out * std::cos(a) - beside * std::sin(a), out * std::sin(a) + beside * std::cos(a),
          -along * std::sin(t) + above_mm * std::cos(t)};
}

simulator::Scene scene_of(const Sheet& sheet, std::int64_t seed) {
  simulator::Scene scene;
  scene.seed = seed;
  scene.camera.width = 480;
  scene.camera.height = 320;
  scene.camera.mm_per_pixel = 0.41;
  scene.camera.full_well_electrons = 160000;
  scene.camera.exposure_us = 12000;
  scene.camera.vignette = {4, 0};
  scene.lights.rings = {{3, 35, 0}, {3, 62, 60}};
  scene.geometry.cloth_height_mm = -80;  // the table, below every sheet
  scene.effects.near_light = scene.effects.noise = scene.effects.vignetting = true;
  scene.material.albedo = {0.1, 0.1, 0.1};
  const auto add = [&](simulator::PatternSettings pattern, Vec3 centre) {
    simulator::TargetSettings& target = scene.targets.emplace_back();
    target.pattern = std::move(pattern);
    target.centre_mm = centre;
    target.tilt_deg = sheet.tilt_deg;
    target.azimuth_deg = sheet.azimuth_deg;
    target.rotation_deg = sheet.rotation_deg;
  };
  for (std::size_t i = 0; i < kTags_mm.size(); ++i) {
    add(simulator::TagSettings{.id = static_cast<int>(i), .side_mm = kTag_mm, .margin_mm = 3},
        on_sheet(sheet, kTags_mm[i][0], kTags_mm[i][1], 0.005));
  }
  add(simulator::PaperSettings{300, 220}, {});
  return scene;
}

// Copies of a folder of captures are what tests spoil.
class CalibrateLights : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    fs::remove_all(captures());
    fs::create_directories(captures());
    for (std::size_t i = 0; i < kFive.size(); ++i)
      render(kFive[i], captures() / fmt::format("sheet{}.weft", i + 1), static_cast<std::int64_t>(i));
    const NearLights truth = exact_lights();
    std::string rig;
    for (std::size_t k = 0; k < truth.leds.size(); ++k) {
      const double angle = 2.4 * static_cast<double>(k);
      const Vec3 p = truth.leds[k].position_mm +
                     10.0 * Vec3{0.8 * std::cos(angle), 0.8 * std::sin(angle), k % 2 == 0 ? 0.6 : -0.6};
      rig += fmt::format("[[led]]\nposition_mm = [{:.1f}, {:.1f}, {:.1f}]\n", p.x, p.y, p.z);
    }
    ASSERT_TRUE(write_file(captures() / "rig.toml", rig));
    ASSERT_TRUE(write_file(captures() / "sheet.toml", sheet_toml()));
  }
  static void TearDownTestSuite() { fs::remove_all(captures()); }

  void SetUp() override {
    work_ = fs::path(testing::TempDir()) /
            fmt::format("weft_lights_{}_{}", getpid(),
                        testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(work_);
    fs::create_directories(work_);
    fs::copy(captures(), work_ / "lights", fs::copy_options::recursive);
    options_.input = work_ / "lights";
    options_.from = captures() / "sheet1.weft" / "calibration";
    options_.output = work_ / "new";
  }
  void TearDown() override { fs::remove_all(work_); }

  static fs::path captures() {
    return fs::path(testing::TempDir()) / fmt::format("weft_lights_{}", getpid());
  }
  static std::string sheet_toml() {
    std::string text = "width_mm = 300\nheight_mm = 220\nmargin_mm = 5\nreflectance = 0.9\n";
    for (std::size_t i = 0; i < kTags_mm.size(); ++i)
      text += fmt::format("[[tag]]\nid = {}\nside_mm = {}\ncentre_mm = [{}, {}]\n", i, kTag_mm,
                          kTags_mm[i][0], kTags_mm[i][1]);
    return text;
  }
  static NearLights exact_lights() {
    return std::get<NearLights>(*read_calibration(captures() / "sheet1.weft" / "calibration")->lights);
  }
  static void render(
      const Sheet& sheet, const fs::path& folder, std::int64_t seed,
      const std::function<void(simulator::Scene&)>& change = [](simulator::Scene&) {}) {
    simulator::Scene scene = scene_of(sheet, seed);
    change(scene);
    simulator::SimulateOptions options;
    options.truth = false;
    const auto report = simulator::simulate_session(scene, folder, options);
    ASSERT_TRUE(report) << report.error().message();
  }
  /// Renders one of the five captures again.
  void replace(int capture, const std::function<void(simulator::Scene&)>& change) const {
    const fs::path folder = work_ / "lights" / fmt::format("sheet{}.weft", capture);
    fs::remove_all(folder);
    render(kFive[static_cast<std::size_t>(capture - 1)], folder, 90 + capture, change);
  }
  calibration::CalibrateOutcome done() {
    Result<calibration::CalibrateOutcome> outcome = calibration::calibrate_lights(options_, {});
    EXPECT_TRUE(outcome) << outcome.error().message();
    return outcome ? std::move(*outcome) : calibration::CalibrateOutcome();
  }
  std::string refusal() {
    const Result<calibration::CalibrateOutcome> outcome = calibration::calibrate_lights(options_, {});
    EXPECT_FALSE(outcome) << "it was accepted";
    EXPECT_FALSE(fs::exists(options_.output)) << "nothing may be written";
    return outcome ? std::string() : outcome.error().message();
  }
  /// The verdict that says this; one without a name where none does.
  static Verdict verdict_of(const calibration::CalibrateOutcome& outcome, const std::string& part) {
    const std::vector<Verdict>& all = outcome.report.verdicts;
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Verdict& v) { return v.text.find(part) != v.text.npos; });
    return found == all.end() ? Verdict() : *found;
  }

  fs::path work_;
  calibration::CalibrateLightsOptions options_;
};

TEST_F(CalibrateLights, FindsTheRigFromFiveSessionsOfASheet) {
  const calibration::CalibrateOutcome outcome = done();
  const Result<Calibration> written = read_calibration(options_.output);
  ASSERT_TRUE(written) << written.error().message();
  const NearLights found = std::get<NearLights>(*written->lights);
  EXPECT_LT(test::position_error_mm(found, exact_lights()), 0.5);
  EXPECT_LT(test::direction_error_deg(found, exact_lights()), 0.05);
  for (std::size_t k = 0; k < found.leds.size(); ++k) {
    // The gain's mean is 0 in ours and the vignette's is 1 at the centre: the product counts.
    const double ours = found.leds[k].flux_rgb[1] * std::exp(found.log_gain(k, 1, 0, 0));
    const NearLights truth = exact_lights();
    EXPECT_NEAR(ours / (truth.leds[k].flux_rgb[1] * std::exp(truth.log_gain(k, 1, 0, 0))), 1, 0.01)
        << "LED " << k + 1;
  }
  EXPECT_EQ(written->subject.albedo_scale, AlbedoScale::kAbsolute);
  ASSERT_TRUE(written->light_covariance);
  EXPECT_EQ(written->camera, read_calibration(options_.from)->camera);
  EXPECT_TRUE(fs::exists(options_.output / "report" / "lights.html"));
  EXPECT_LT(outcome.report.numbers["chi_square"].get<double>(), 1.5);
  EXPECT_LT(outcome.report.numbers["predicted_normal_deg"]["corner"].get<double>(), 0.35);
}

TEST_F(CalibrateLights, ByThePixelWritesMapsOfEveryLed) {
  options_.method = calibration::LightsMethod::kPerPixel;
  const calibration::CalibrateOutcome outcome = done();
  const auto map = read_image(options_.output / "report" / "led06_direction.exr");
  ASSERT_TRUE(map) << map.error().message();
  EXPECT_EQ(map->info.size.width, 26);
  const View<const float> z = map->channel("Z");
  const Vec3 led = exact_lights().leds[5].position_mm;
  EXPECT_NEAR(static_cast<double>(z(13, 8)), led.z / length(led), 0.02);
  EXPECT_TRUE(fs::exists(options_.output / "report" / "led01_intensity.exr"));
  EXPECT_GT(outcome.report.numbers["per_pixel"]["rounds"].get<int>(), 1);
}

TEST_F(CalibrateLights, AsTheSeedDoesSaysWhatItCannotDo) {
  options_.method = calibration::LightsMethod::kSeed;
  const calibration::CalibrateOutcome outcome = done();
  EXPECT_EQ(verdict_of(outcome, "finds no directions").name, "NO_DIRECTIONS");
  const Json& steps = outcome.report.numbers["seed"];
  ASSERT_EQ(steps.size(), 6u);
  EXPECT_LT(steps[5]["paper_residual_deg"].get<double>(), steps[0]["paper_residual_deg"].get<double>());
  const NearLights tape = *capture::read_rig(options_.input / "rig.toml")->lights;
  EXPECT_EQ(std::get<NearLights>(*read_calibration(options_.output)->lights).leds[3].position_mm,
            tape.leds[3].position_mm);
}

TEST_F(CalibrateLights, LeavesOutPatchesThatTheOldLightsMeasured) {
  Calibration patched = *read_calibration(options_.from);
  patched.patches = {{{{10, 10}, {30, 10}, {30, 30}}, {0.5, 0.5, 0.5}}};
  ASSERT_TRUE(write_calibration(work_ / "patched", patched));
  options_.from = work_ / "patched";
  options_.method = calibration::LightsMethod::kSeed;
  const calibration::CalibrateOutcome outcome = done();
  EXPECT_THAT(outcome.warnings, testing::Contains(HasSubstr("weft calibrate patches")));
  EXPECT_TRUE(outcome.calibration.patches.empty());
  options_.input = "nothing";
  const auto again = calibration::calibrate_lights(options_, {});
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().kind, ErrorKind::kCannotCreate) << "the output is looked at first";
}

TEST_F(CalibrateLights, TakesARigFileThatSaysNothingOfPositionsForNone) {
  ASSERT_TRUE(write_file(options_.input / "rig.toml", "name = \"north\"\n[board]\nport = \"/dev/x\"\n"));
  Calibration dark = *read_calibration(options_.from);
  dark.lights.reset();
  ASSERT_TRUE(write_calibration(work_ / "without lights", dark));
  options_.from = work_ / "without lights";
  EXPECT_THAT(refusal(), HasSubstr("it has no [[led]]"));
}

TEST(MergedBlocks, ReachAllEdgesOfTheFrame) {
  const Size size = {4928, 3264};
  calibration::SheetCaptures all;
  calibration::SheetCapture& capture = all.captures.emplace_back();
  calibration::SheetBlockGrid& grid = capture.leds.emplace_back(size, all.block_px);
  for (calibration::BlockMean& block : grid.blocks) block.reading = 1;
  all.columns = grid.columns;
  all.rows = grid.rows;
  const auto blocks = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  capture.is_paper.assign(blocks, 1);
  const auto readings = calibration::merged_blocks(all, {std::vector<char>(blocks)}, {size, 26, 17});
  ASSERT_EQ(readings.size(), 26U * 17U);
  EXPECT_LT(readings.front().x_px, 100);
  EXPECT_GT(readings.back().x_px, 4928 - 100) << "of 4928 pixels";
  EXPECT_GT(readings.back().y_px, 3264 - 100) << "of 3264 pixels";
}

TEST_F(CalibrateLights, FromOneFlatSheetIsWeakAndSaysSo) {
  for (int i = 2; i <= 5; ++i) fs::remove_all(options_.input / fmt::format("sheet{}.weft", i));
  const calibration::CalibrateOutcome outcome = done();
  EXPECT_THAT(verdict_of(outcome, "weakly known, from 1 pose").remedy, HasSubstr("tilted"));
  EXPECT_GT(outcome.report.numbers["worst_position_sigma_mm"].get<double>(), 4);
}

TEST_F(CalibrateLights, AreNotAcceptedOnASessionThatTheyWereFittedTo) {
  // One whose journal has no digests counts by its files.
  Session first = *read_session(options_.input / "sheet1.weft");
  for (Shot& shot : first.shots) shot.sha256.clear();
  ASSERT_TRUE(write_session(first));
  done();
  render({0, 0, 180}, work_ / "turned.weft", 50);
  const auto verdicts = [&](const fs::path& session) {
    const auto checked = calibration::calibrate_check(
        {.input = session, .from = options_.output, .sheet = options_.input / "sheet.toml"}, {});
    EXPECT_TRUE(checked) << checked.error().message();
    std::vector<std::string> names;
    if (!checked) return names;
    for (const Verdict& verdict : checked->report.verdicts) names.push_back(verdict.name);
    return names;
  };
  for (const char* fitted : {"sheet1.weft", "sheet3.weft"})
    EXPECT_THAT(verdicts(options_.input / fitted), testing::ElementsAre("FITTED_TO_IT")) << fitted;
  EXPECT_THAT(verdicts(work_ / "turned.weft"), testing::IsEmpty());
}

TEST_F(CalibrateLights, SayWhereTheGateIsLaxAndHowToMakeItStrict) {
  const calibration::CalibrateOutcome lax = done();
  const double chi_square = lax.report.numbers["chi_square"].get<double>();
  ASSERT_LT(chi_square, 0.5) << "the simulated sheet is flatter than 0.05 degrees";
  ASSERT_THAT(lax.warnings, testing::Contains(HasSubstr("--flatness below 0.05")));
  EXPECT_THAT(lax.report.sections[0].paragraphs[1],
              HasSubstr(fmt::format("by a factor of {:.1f}", 1 / chi_square)));
  EXPECT_EQ(verdict_of(lax, "lax").name, "") << "it is a remark";
  options_.output = work_ / "strict";
  options_.flatness_deg = 0.01;
  const calibration::CalibrateOutcome strict = done();
  EXPECT_GT(strict.report.numbers["chi_square"].get<double>(), 1.2 * chi_square);
}

TEST_F(CalibrateLights, AsTheSeedDoesPrintsItsStepsAndSaysEverythingOnce) {
  const test::Outcome run =
      test::run_weft({"calibrate", "lights", options_.input.string(), "--from", options_.from.string(),
                      "--method", "seed", "-o", options_.output.string(), "--quiet"});
  EXPECT_EQ(run.exit_code, 0) << run.error;
  EXPECT_THAT(run.output, HasSubstr("directions not updated by this step"));
  const std::size_t once = run.error.find("finds no directions");
  ASSERT_NE(once, run.error.npos) << run.error;
  EXPECT_EQ(run.error.find("finds no directions", once + 1), run.error.npos) << run.error;
}

TEST_F(CalibrateLights, NamesTwoCapturesOfOnePose) {
  const fs::path twin = options_.input / "sheet5.weft";
  fs::remove_all(twin);
  render(kFive[3], twin, 77);
  const calibration::CalibrateOutcome outcome = done();
  EXPECT_THAT(verdict_of(outcome, "sheet4.weft and sheet5.weft show the sheet in one pose").remedy,
              HasSubstr("turn the sheet"));
  for (const Verdict& verdict : outcome.report.verdicts) {
    EXPECT_FALSE(verdict.remedy.empty()) << verdict.text;
    EXPECT_THAT(outcome.warnings, Not(testing::Contains(HasSubstr(verdict.text)))) << "said twice";
  }
}

TEST_F(CalibrateLights, LeavesOutAStainAndNamesItsPlace) {
  for (int i = 1; i <= 5; ++i) {
    replace(i, [&](simulator::Scene& scene) {
      simulator::TargetSettings& stain = scene.targets.emplace_back(scene.targets.back());
      stain.pattern = simulator::PaperSettings{14, 14};
      stain.white = 0.7;
      stain.centre_mm = on_sheet(kFive[static_cast<std::size_t>(i - 1)], 20, -15, 0.01);
    });
  }
  const calibration::CalibrateOutcome outcome = done();
  EXPECT_EQ(verdict_of(outcome, "stain").name, "PAPER_FAULT");
  const Json& fault = outcome.report.numbers["faults"][0];
  EXPECT_NEAR(fault["u_mm"].get<double>(), 20, 2);
  EXPECT_NEAR(fault["v_mm"].get<double>(), -15, 2);
  EXPECT_LT(test::position_error_mm(std::get<NearLights>(*outcome.calibration.lights), exact_lights()), 0.5);
}

TEST_F(CalibrateLights, LeavesOutAFoldAndTellsItFromAStain) {
  // A strip of the flat sheet that leans by 3 degrees.
  replace(1, [](simulator::Scene& scene) {
    simulator::TargetSettings& fold = scene.targets.emplace_back(scene.targets.back());
    fold.pattern = simulator::PaperSettings{12, 50};
    fold.tilt_deg = 3;
    fold.centre_mm = on_sheet(kFive[0], -30, 10, 0.35);
  });
  const calibration::CalibrateOutcome outcome = done();
  EXPECT_EQ(verdict_of(outcome, "fold").name, "PAPER_FAULT");
  const Json& fault = outcome.report.numbers["faults"][0];
  EXPECT_NEAR(fault["u_mm"].get<double>(), -30, 2);
  EXPECT_NEAR(fault["v_mm"].get<double>(), 10, 3);
  EXPECT_LT(test::position_error_mm(std::get<NearLights>(*outcome.calibration.lights), exact_lights()), 0.5);
}

TEST_F(CalibrateLights, RefusesPaperWithALargeStain) {
  for (int i = 1; i <= 5; ++i) {
    replace(i, [&](simulator::Scene& scene) {
      simulator::TargetSettings& stain = scene.targets.emplace_back(scene.targets.back());
      stain.pattern = simulator::PaperSettings{60, 60};
      stain.white = 0.8;
      stain.centre_mm = on_sheet(kFive[static_cast<std::size_t>(i - 1)], 20, -15, 0.01);
    });
  }
  EXPECT_THAT(refusal(), HasSubstr("not an even, flat white"));
}

TEST_F(CalibrateLights, RefusesASheetThatMovedBetweenItsPhotographs) {
  // A tilted sheet whose second half of photographs shows it 3 degrees lower.
  const fs::path folder = options_.input / "sheet2.weft", other = work_ / "other.weft";
  render({17, 0}, other, 5);
  Session session = *read_session(folder);
  for (Shot& shot : session.shots) {
    if (shot.led <= 3) continue;
    fs::copy_file(other / shot.file, folder / shot.file, fs::copy_options::overwrite_existing);
    shot.sha256.clear();
  }
  ASSERT_TRUE(write_session(session));
  EXPECT_THAT(refusal(), AnyOf(HasSubstr("contradict each other"), HasSubstr("not an even, flat white")));
}

TEST_F(CalibrateLights, RefusesAFrameThatIsNotTheOneThatWasCaptured) {
  const Session session = *read_session(options_.input / "sheet2.weft");
  const fs::path file = session.path_of(*session.lit()[3]);
  fs::copy_file(session.path_of(*session.lit()[2]), file, fs::copy_options::overwrite_existing);
  const std::string message = refusal();
  EXPECT_THAT(message, HasSubstr("frame is not the one that was captured"));
  EXPECT_THAT(message, HasSubstr(file.filename().string()));
}

TEST_F(CalibrateLights, NamesALedThatDidNotLight) {
  replace(3, [&](simulator::Scene& scene) {
    scene.damage.push_back({.kind = simulator::DamageKind::kBlack, .first_led = 4, .last_led = 4});
  });
  const std::string message = refusal();
  EXPECT_THAT(message, HasSubstr("LED 4 did not light"));
  EXPECT_THAT(message, HasSubstr("sheet3.weft"));
}

TEST_F(CalibrateLights, NamesPaperThatIsFull) {
  replace(2, [&](simulator::Scene& scene) { *scene.camera.exposure_us = 60000; });
  const std::string message = refusal();
  EXPECT_THAT(message, HasSubstr("sheet2.weft"));
  EXPECT_THAT(message, HasSubstr("shorter exposure"));
}

TEST_F(CalibrateLights, NamesASessionThatWasExposedDifferently) {
  replace(4, [&](simulator::Scene& scene) { *scene.camera.exposure_us = 9000; });
  const std::string message = refusal();
  EXPECT_THAT(message, HasSubstr("sheet4.weft"));
  EXPECT_THAT(message, HasSubstr("one exposure"));
}

TEST_F(CalibrateLights, NamesAFileOfAnotherApertureOrSize) {
  replace(4, [&](simulator::Scene& scene) { scene.camera.f_number = 5.6; });
  EXPECT_THAT(refusal(), HasSubstr("f/5.6"));
  replace(4, [&](simulator::Scene& scene) { scene.camera.width = 500; });
  EXPECT_THAT(refusal(), HasSubstr("500 x 320"));
  replace(4, [&](simulator::Scene& scene) { scene.camera.body = simulator::Body::kD5100; });
  EXPECT_THAT(refusal(), HasSubstr("sheet4.weft"));
}

TEST_F(CalibrateLights, NamesAFileWhoseCountsMeanAnotherLight) {
  Session session = *read_session(options_.input / "sheet2.weft");
  Shot& shot = session.shots.front();
  Result<RawFrame> frame = capture::decode_raw(session.path_of(shot));
  ASSERT_TRUE(frame) << frame.error().message();
  frame->white *= 4;
  ASSERT_TRUE(simulator::write_dng(session.path_of(shot), *frame));
  shot.sha256 = *sha256_of_file(session.path_of(shot));
  ASSERT_TRUE(write_session(session));
  const std::string message = refusal();
  EXPECT_THAT(message, HasSubstr(shot.file));
  EXPECT_THAT(message, HasSubstr("levels are not those of the calibration"));
  EXPECT_THAT(message, HasSubstr(fmt::format("{:.0f} white", frame->white)));
}

TEST_F(CalibrateLights, NamesASheetWithoutItsTags) {
  replace(4, [&](simulator::Scene& scene) {
    scene.targets.erase(scene.targets.begin(), scene.targets.begin() + 3);
  });
  EXPECT_THAT(refusal(), HasSubstr("sheet4.weft"));
}

TEST_F(CalibrateLights, NamesWhatIsMissing) {
  options_.from.clear();
  EXPECT_THAT(refusal(), HasSubstr("--from"));
  options_.from = captures() / "sheet1.weft" / "calibration";
  fs::remove(options_.input / "sheet.toml");
  EXPECT_THAT(refusal(), HasSubstr("sheet.toml"));
  options_.input = work_ / "empty";
  fs::create_directories(options_.input);
  ASSERT_TRUE(write_file(options_.input / "sheet.toml", sheet_toml()));
  EXPECT_THAT(refusal(), HasSubstr("no session"));
}

TEST_F(CalibrateLights, NamesWhatIsWrongInItsDescriptions) {
  const auto sheet = [&](const std::string& text) {
    EXPECT_TRUE(write_file(options_.input / "sheet.toml", text));
    const auto read = calibration::read_sheet_file(options_.input / "sheet.toml");
    return read ? std::string("accepted") : read.error().message();
  };
  const std::string tag = "[[tag]]\nid = 1\nside_mm = 5\ncentre_mm = [1, 2]\n";
  EXPECT_EQ(sheet("width_mm = 100\nheight_mm = 50\n" + tag), "accepted");
  EXPECT_THAT(sheet("width_mm = 100\n" + tag), HasSubstr("height_mm"));
  EXPECT_THAT(sheet("width_mm = 100\nheight_mm = 50\nwith = 1\n" + tag),
              HasSubstr("with: there is no such key"));
  EXPECT_THAT(sheet("width_mm = 100\nheight_mm = 50\nreflectance = 1.4\n" + tag), HasSubstr("reflectance"));
  EXPECT_THAT(sheet("width_mm = 100\nheight_mm = 50\nmargin_mm = 25\n" + tag), HasSubstr("margin_mm"));
  EXPECT_THAT(sheet("width_mm = 100\nheight_mm = 50\n" + tag + tag), HasSubstr("another tag"));
  EXPECT_THAT(sheet("width_mm = 100\nheight_mm = 50\n"), HasSubstr("[[tag]]"));
  EXPECT_THAT(sheet("width_mm = 100\nheight_mm\n"), HasSubstr("line"));
}

}  // namespace
}  // namespace weft::app
