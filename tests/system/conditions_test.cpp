// SPDX-License-Identifier: Apache-2.0
// The conditions a session was taken in: each fault is simulated, solved with its correction and without, and
// held against the truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/describe/field_json.h"
#include "core/image_io/image_io.h"
#include "core/rig/calibration.h"
#include "core/solve/solve_record.h"
#include "simulator/camera/dng_writer.h"
#include "solve/bands/bands.h"
#include "solve/bands/calibration_channels.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

// Normals and status of a session in memory, and what its loading said.
struct Solved {
  Image<float> normal;
  Image<std::uint16_t> status;
  Json conditions;
  std::vector<std::string> warnings;
  std::vector<Photosite> replaced;
  NoiseModel noise;
};

template <typename T>
T need(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return *std::move(result);
}

Solved solve(const solve::Photographs& photographs) {
  const solve::Mosaics* mosaics = photographs.mosaics();
  Solved out = {Image<float>(photographs.size, 3),
                Image<std::uint16_t>(photographs.size),
                object_of(photographs.conditions.facts),
                photographs.conditions.warnings,
                mosaics != nullptr ? mosaics->replaced : std::vector<Photosite>(),
                photographs.noise().value_or(NoiseModel())};
  const auto keep = [&](const solve::MapBand& band) -> Result<void> {
    for (int y = band.rows.y0; y < band.rows.y1; ++y) {
      for (int p = 0; p < 3; ++p) {
        std::copy_n(band.normal[static_cast<std::size_t>(p)].row(y - band.rows.y0), photographs.size.width,
                    out.normal.plane(p).row(y));
      }
      std::copy_n(band.status.row(y - band.rows.y0), photographs.size.width, out.status.plane().row(y));
    }
    return {};
  };
  need(solve::solve_bands(photographs, *solver::fast_method(), {}, {}, keep));
  return out;
}

Solved solve(const fs::path& session, const fs::path& calibration = {}) {
  return solve(need(solve::load_photographs(need(solve::plan_session({session, calibration, {}})), {})));
}

// Degrees between the mean normal of an area and that of a level card: errors that noise does not hide.
double bias_deg(const Solved& solved, Rect area) {
  Vec3 sum;
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      sum = sum + Vec3{solved.normal(x, y, 0), solved.normal(x, y, 1), solved.normal(x, y, 2)};
    }
  }
  return angle_deg(sum, {0, 0, 1});
}

// Mean error in degrees against the session's truth of the pixels that `counts` takes.
double mean_error_deg(
    const Solved& solved, const fs::path& session,
    const std::function<bool(int x, int y)>& counts = [](int, int) { return true; }) {
  const LoadedImage truth = need(read_image(session / "truth" / "normal.exr"));
  double sum = 0;
  int pixels = 0;
  for (int y = 0; y < solved.normal.height(); ++y) {
    for (int x = 0; x < solved.normal.width(); ++x) {
      if (!counts(x, y)) continue;
      const auto at = [&](const Image<float>& n) { return Vec3{n(x, y, 0), n(x, y, 1), n(x, y, 2)}; };
      sum += angle_deg(at(solved.normal), at(truth.planes));
      ++pixels;
    }
  }
  EXPECT_GT(pixels, 0);
  return sum / std::max(pixels, 1);
}

class Conditions : public testing::Test {
 protected:
  void edit_session(const std::function<void(Json&)>& change) const {
    edit_json(session_ / "session.json", change);
  }
  void remove_shots(const std::string& role) const {
    edit_session([&](Json& s) {
      Json kept = Json::array();
      for (const Json& shot : s["shots"]) {
        if (shot["role"] != role) kept.push_back(shot);
      }
      s["shots"] = kept;
    });
  }
  /// Writes the session's calibration, changed, as another one.
  fs::path other_calibration(const std::function<void(Calibration&)>& change) const {
    Calibration calibration = need(read_calibration(session_ / "calibration"));
    change(calibration);
    need(write_calibration(work_ / "other", calibration));
    return work_ / "other";
  }
  /// Changes the counts of the frame of shot `index`.
  void change_raw(std::size_t index, const std::function<void(RawFrame&)>& change) const {
    edit_session([&](Json& s) {
      const fs::path file = session_ / s["shots"][index]["file"].get<std::string>();
      RawFrame frame = need(capture::decode_raw(file));
      change(frame);
      EXPECT_TRUE(simulator::write_dng(file, frame));
      s["shots"][index]["sha256"] = *sha256_of_file(file);
    });
  }
  void put_led_dark(std::size_t led) const {
    change_raw(led - 1, [&](RawFrame& frame) {
      const std::uint16_t own = frame.counts(0, 0);  // two LEDs with one file are refused
      frame.counts = std::move(need(capture::decode_raw(dark())).counts);
      frame.counts(0, 0) = own;
    });
  }
  fs::path dark() const { return session_ / "raw" / "10_led00.dng"; }

  Workspace work_;
  const fs::path session_ = work_ / "cloth.weft";
};

class BadPhotosites : public Conditions {
 protected:
  struct Errors {
    double replaced_deg = 0;   ///< at the replaced photosites
    double as_taken_deg = 0;   ///< there, from the counts as they were taken
    double elsewhere_deg = 0;  ///< at all the others
    std::size_t photosites = 0;
  };
  /// Simulates a scene with 2 in 1000 photosites hot and 1 in 1000 dead.
  Errors errors_of(simulator::Scene scene) const {
    scene.camera.defects.hot_per_million = 2000;
    scene.camera.defects.dead_per_million = 1000;
    scene.camera.defects.temperature_c = 45;
    scene.effects.dark_current = scene.effects.noise = true;
    simulate(scene, session_);
    const solve::SolvePlan plan = need(solve::plan_session({session_, {}, {}}));
    solve::Photographs loaded = need(solve::load_photographs(plan, {}));
    const Solved with = solve(loaded);
    EXPECT_EQ(with.conditions["hot_photosites"], with.replaced.size());
    for (const auto& [y, x] : with.replaced) {
      EXPECT_TRUE(with.status(x, y) & kInvalidReading) << x << ' ' << y;
    }

    std::vector<RawFrame> as_taken;
    for (const Shot& shot : plan.lit) as_taken.push_back(need(capture::decode_raw(session_ / shot.file)));
    const solve::Mosaics& mosaics = *loaded.mosaics();
    solve::Mosaics unmended(std::move(as_taken), need(capture::decode_raw(dark())), mosaics.response,
                            mosaics.exposure);
    unmended.replaced = mosaics.replaced;
    loaded.frames = std::move(unmended);
    const auto is_bad = [&](int x, int y) {
      return std::binary_search(with.replaced.begin(), with.replaced.end(), Photosite{y, x});
    };
    const Errors errors = {
        mean_error_deg(with, session_, is_bad), mean_error_deg(solve(loaded), session_, is_bad),
        mean_error_deg(with, session_, [&](int x, int y) { return !is_bad(x, y); }), with.replaced.size()};
    RecordProperty("replaced_deg", std::to_string(errors.replaced_deg));
    RecordProperty("as_taken_deg", std::to_string(errors.as_taken_deg));
    RecordProperty("elsewhere_deg", std::to_string(errors.elsewhere_deg));
    return errors;
  }
};

TEST_F(BadPhotosites, OfASphereAreReplacedAndSayThatTheyWere) {
  simulator::Scene scene = scene_named("sensor", {320, 240});
  scene.camera.exposure_us.reset();
  scene.camera.albedo_at_full = 0.3;
  const Errors errors = errors_of(scene);
  EXPECT_NEAR(static_cast<double>(errors.photosites), 76800 * 0.003, 60);
  EXPECT_LT(errors.replaced_deg, errors.as_taken_deg / 50)
      << errors.replaced_deg << " replaced, " << errors.as_taken_deg << " as taken";
  EXPECT_LT(errors.replaced_deg, 2 * errors.elsewhere_deg);
}

TEST_F(BadPhotosites, OfAFineWeaveAreReplacedByWhatIsFourPixelsWide) {
  simulator::Scene scene = scene_named("plain", {320, 240});
  const Errors errors = errors_of(scene);
  EXPECT_LT(errors.replaced_deg, errors.as_taken_deg / 2)
      << errors.replaced_deg << " replaced, " << errors.as_taken_deg << " as taken";
}

TEST_F(Conditions, PhotositesThatHotPngNamesAreReplacedEverywhere) {
  simulate(scene_named("golden", {48, 32}), session_);
  Image<float> picture({48, 32});
  picture(7, 5) = picture(30, 20) = 1;
  const fs::path file = work_ / "bad.png";
  ASSERT_TRUE(write_image(file, std::vector<View<const float>>{picture.plane()}, {"Y"},
                          {.type = SampleType::kUint8}));
  const fs::path other = other_calibration([&](Calibration& c) { c.hot_picture = file; });
  const Solved solved = solve(session_, other);
  EXPECT_THAT(solved.replaced, ElementsAre(Photosite{5, 7}, Photosite{20, 30}));
  EXPECT_TRUE(solved.status(7, 5) & kInvalidReading);
  EXPECT_FALSE(solved.status(8, 5) & kInvalidReading);

  Image<float> wrong({32, 32});
  ASSERT_TRUE(
      write_image(file, std::vector<View<const float>>{wrong.plane()}, {"Y"}, {.type = SampleType::kUint8}));
  fs::remove_all(other);
  other_calibration([&](Calibration& c) { c.hot_picture = file; });
  expect_refusal(work_, {"solve", session_.string(), "--quiet", "--calibration", other.string()}, 65,
                 {"hot.png differs in size", "32 x 32", "48 x 32"});
  std::string bytes = bytes_of(other / "hot.png");
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  put_bytes(other / "hot.png", bytes);
  expect_refusal(work_, {"solve", session_.string(), "--quiet", "--calibration", other.string()}, 65,
                 {"changed after it was measured", "hot.png", "calibrate again"});
}

// The fluxes of the calibration are off by up to 3 percent, each by its own.
TEST_F(Conditions, LedsThatChangedSinceTheirCalibrationAreToldByTheCloth) {
  simulator::Scene scene = scene_named("smooth", {320, 256});
  simulate(scene, session_);
  const fs::path other = other_calibration([](Calibration& c) {
    auto& leds = std::get<NearLights>(*c.lights).leds;
    for (std::size_t k = 0; k < leds.size(); ++k) {
      for (double& flux : leds[k].flux_rgb) flux *= 1 + 0.03 * std::sin(2.4 * static_cast<double>(k));
    }
  });
  const Solved right = solve(session_), told = solve(session_, other);
  EXPECT_FALSE(right.conditions.contains("cloth_gains"));
  ASSERT_TRUE(told.conditions.contains("cloth_gains")) << told.conditions;
  EXPECT_EQ(told.conditions["cloth_gains"]["leds"].size(), 10U);
  solve::Photographs as_calibrated =
      need(solve::load_photographs(need(solve::plan_session({session_, other, {}})), {}));
  as_calibrated.field = need(LightField::make(*need(read_calibration(other)).lights, as_calibrated.camera,
                                              as_calibrated.size, as_calibrated.field->cloth_height_mm()));
  const double alone = mean_error_deg(solve(as_calibrated), session_);
  const double with = mean_error_deg(told, session_), best = mean_error_deg(right, session_);
  RecordProperty("off_deg", std::to_string(alone));
  RecordProperty("told_deg", std::to_string(with));
  RecordProperty("right_deg", std::to_string(best));
  EXPECT_LT(with, best + 0.3 * (alone - best))
      << alone << " by the calibration, " << best << " by right fluxes";
  EXPECT_GT(alone, 1.3 * best);
}

TEST_F(Conditions, DriftIsTakenFromTheRepeatShot) {
  simulator::Scene scene = scene_named("drift", {320, 240});
  scene.lights.drift = 0.05;
  scene.lights.flicker = 0;
  scene.effects.stray = scene.effects.ambient = false;
  scene.camera.retakes.repeat = true;
  simulate(scene, session_);
  const Solved with = solve(session_);
  ASSERT_EQ(with.conditions["drift"].size(), 10U);
  for (int k = 0; k < 10; ++k) {
    const Json& drift = with.conditions["drift"][static_cast<std::size_t>(k)];
    EXPECT_EQ(drift["led"], k + 1);
    EXPECT_EQ(drift["from"], "repeat");
    EXPECT_NEAR(drift["factor"].get<double>(), 1 - 0.05 * k / 9, 1e-4) << "LED " << k + 1;
  }
  EXPECT_THAT(with.warnings, ElementsAre());
  remove_shots("repeat");
  const Solved without = solve(session_);
  EXPECT_FALSE(without.conditions.contains("drift"));
  const Rect all = {0, 0, 320, 240};
  const double b = bias_deg(without, all), a = bias_deg(with, all);
  RecordProperty("bias_with", std::to_string(a));
  RecordProperty("bias_without", std::to_string(b));
  EXPECT_GT(b, 0.3);
  EXPECT_LT(a, b / 50) << a << " with, " << b << " without";
}

TEST_F(Conditions, AWhitePatchGivesEachLedItsOwnFactorAndWinsOverTheRepeat) {
  simulator::Scene scene = scene_named("drift", {320, 240});
  scene.lights.flicker = 0.02;  // which no repeat can tell
  scene.effects.stray = scene.effects.ambient = false;
  scene.camera.retakes.repeat = true;
  simulate(scene, session_);
  const Solved by_repeat = solve(session_);
  const fs::path other = other_calibration([](Calibration& c) {
    c.patches = {{{{10, 10}, {109, 10}, {109, 99}, {10, 99}}, {0.5, 0.5, 0.5}}};  // the card itself
  });
  const Solved by_patch = solve(session_, other);
  ASSERT_EQ(by_patch.conditions["drift"].size(), 10U);
  EXPECT_EQ(by_patch.conditions["drift"][0]["from"], "patches");
  EXPECT_EQ(by_repeat.conditions["drift"][0]["from"], "repeat");
  const Rect beside = {160, 120, 320, 240};
  const double a = bias_deg(by_patch, beside), b = bias_deg(by_repeat, beside);
  RecordProperty("bias_patch", std::to_string(a));
  RecordProperty("bias_repeat", std::to_string(b));
  EXPECT_LT(a, b / 20) << a << " by patch, " << b << " by repeat";
}

TEST_F(Conditions, ALedThatWasCoveredIsNamedAndNotCorrected) {
  simulator::Scene scene = scene_named("drift", {96, 64});
  simulate(scene, session_);
  change_raw(3, [](RawFrame& frame) {
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 96; ++x) {
        frame.counts(x, y) = static_cast<std::uint16_t>(600 + (frame.counts(x, y) - 600) / 2);
      }
    }
  });
  const fs::path other = other_calibration([](Calibration& c) {
    c.patches = {{{{10, 10}, {50, 10}, {50, 50}, {10, 50}}, {0.5, 0.5, 0.5}}};
  });
  const Solved solved = solve(session_, other);
  ASSERT_EQ(solved.warnings.size(), 1U);
  EXPECT_THAT(solved.warnings[0], HasSubstr("LED 4 gave 0."));
  EXPECT_THAT(solved.warnings[0], HasSubstr("covered"));
  EXPECT_EQ(solved.conditions["drift"][3]["factor"], 1);
}

TEST_F(Conditions, ABracketSavesWhatIsSaturatedByItsMeasuredRatio) {
  simulator::Scene scene = scene_named("tilted", {320, 240});
  scene.effects.noise = true;
  scene.camera.albedo_at_full = 0.1;  // the card has 0.5: five times too long
  scene.material.albedo = {0.5, 0.5, 0.5};
  scene.camera.retakes.bracket = 0.2;
  scene.camera.retakes.shutter_error = 0.04;
  simulate(scene, session_);
  edit_session([](Json& s) {  // frames that are full all over are one file
    for (Json& shot : s["shots"]) shot.erase("sha256");
  });
  const Solved with = solve(session_);
  EXPECT_EQ(with.conditions["brackets"], 10);
  const double error_with = mean_error_deg(with, session_);
  const Solved nominal = solve(session_, other_calibration([](Calibration& c) {
                                 ExposureRatio& e = c.response->exposure_ratios.front();
                                 e.ratio = e.exposure_us / e.to_exposure_us;
                               }));
  const double error_nominal = mean_error_deg(nominal, session_);
  remove_shots("bracket");
  const Solved without = solve(session_);
  const double error_without = mean_error_deg(without, session_);
  RecordProperty("error_with", std::to_string(error_with));
  RecordProperty("error_nominal", std::to_string(error_nominal));
  RecordProperty("error_without", std::to_string(error_without));
  EXPECT_LT(error_with, error_without / 4) << error_with << " with, " << error_without << " without";
  EXPECT_LT(error_with, error_nominal) << "the time on the label is 4 percent off";
  const double gathered = 0.2 * 1.04;
  EXPECT_NEAR(with.noise.per_reading, without.noise.per_reading / gathered, 0.001 * with.noise.per_reading)
      << "sigma must hold for what only the bracket saw";
}

TEST_F(Conditions, ALongBracketHalvesTheNoiseOfADarkCloth) {
  simulator::Scene scene = scene_named("flat", {320, 240});
  scene.effects.noise = true;
  scene.material.albedo = {0.01, 0.01, 0.01};
  scene.camera.retakes.bracket = 16;
  simulate(scene, session_);
  const Solved with = solve(session_);
  remove_shots("bracket");
  const Solved without = solve(session_);
  const double a = mean_error_deg(with, session_), b = mean_error_deg(without, session_);
  RecordProperty("error_with", std::to_string(a));
  RecordProperty("error_without", std::to_string(b));
  EXPECT_LT(a, b / 3) << a << " with, " << b << " without";
  EXPECT_LE(with.noise.per_reading, without.noise.per_reading);
}

TEST_F(Conditions, ABracketWithoutMeasuredRatioIsLeftOutAloud) {
  simulator::Scene scene = scene_named("flat", {48, 32});
  scene.camera.retakes.bracket = 0.25;
  simulate(scene, session_);
  const Solved solved =
      solve(session_, other_calibration([](Calibration& c) { c.response->exposure_ratios.clear(); }));
  EXPECT_FALSE(solved.conditions.contains("brackets"));
  ASSERT_EQ(solved.warnings.size(), 10U);
  EXPECT_THAT(solved.warnings[2], HasSubstr("12_led03.dng was left out"));
  EXPECT_THAT(solved.warnings[2], HasSubstr("no measured ratio"));
}

TEST_F(Conditions, ALedThatDidNotLightIsLeftOutByName) {
  simulate(scene_named("golden", {48, 32}), session_);
  const double before = mean_error_deg(solve(session_), session_);
  put_led_dark(7);
  const Solved solved = solve(session_);
  ASSERT_EQ(solved.warnings.size(), 1U);
  EXPECT_THAT(solved.warnings[0], HasSubstr("LED 7 did not light the cloth"));
  EXPECT_EQ(solved.conditions["left_out"], (Json{{{"led", 7}, {"why", "not lit"}}}));
  const double after = mean_error_deg(solved, session_);
  EXPECT_LT(after, 1.5 * before) << before << " with all LEDs, " << after << " with nine";
}

TEST_F(Conditions, ALedThatSaturatesEverythingIsLeftOutByName) {
  simulate(scene_named("golden", {48, 32}), session_);
  change_raw(1, [](RawFrame& frame) {
    for (int y = 0; y < 32; ++y) std::fill_n(frame.counts.plane().row(y), 48, std::uint16_t{15520});
  });
  const Solved solved = solve(session_);
  ASSERT_EQ(solved.warnings.size(), 1U);
  EXPECT_THAT(solved.warnings[0], HasSubstr("LED 2 saturated 100 percent of the frame; it was left out"));
  EXPECT_EQ(solved.conditions["left_out"][0]["led"], 2);
  int saturated = 0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 48; ++x) saturated += (solved.status(x, y) & kSaturated) != 0;
  }
  EXPECT_LT(saturated, 48 * 32 / 2) << "what was left out marks no pixel";
}

TEST_F(Conditions, AScanThatIsOverOrFiveStopsDarkIsNotSolvedWithoutAWarning) {
  for (const auto& [at_full, light, name] :
       {std::tuple{0.25, 1.0, "OVEREXPOSED"}, {0.8, 1 / 32.0, "UNDEREXPOSED"}, {0.8, 1.0, ""}}) {
    simulator::Scene scene = scene_named("golden", {48, 32});
    scene.camera.albedo_at_full = at_full;
    for (auto* albedo : {&scene.material.warp_albedo, &scene.material.weft_albedo}) {
      for (double& share : albedo->value()) share *= light;
    }
    const fs::path session = work_ / (name + std::string("of.weft"));
    simulate(scene, session);
    const Outcome run = run_weft({"solve", session.string(), "--quality", "standard", "--no-previews",
                                  "--quiet", "--strict", "--json"});
    const Json warnings = run.json()["warnings"];
    std::vector<std::string> names;
    for (const Json& warning : warnings) names.push_back(warning["name"]);
    if (*name == 0) {
      EXPECT_THAT(names, testing::Not(testing::Contains(HasSubstr("EXPOSED")))) << warnings;
      continue;
    }
    EXPECT_EQ(run.exit_code, 2) << at_full;
    ASSERT_FALSE(names.empty()) << at_full;
    EXPECT_EQ(names.front(), name) << warnings;
    EXPECT_THAT(std::string(warnings[0]["remedy"]), HasSubstr("scan again with a metered exposure"));
  }
}

TEST_F(Conditions, WithTwoLedsThatLitThereIsNothingToSolve) {
  simulate(scene_named("golden", {48, 32}), session_);
  for (std::size_t led = 3; led <= 10; ++led) put_led_dark(led);
  expect_refusal(work_, {"solve", session_.string(), "--quiet"}, 65,
                 {"too few lights", session_.string(), "LEDs 3, 4, 5, 6, 7, 8, 9, 10 did not light the cloth",
                  "leaves 2"});
}

TEST_F(Conditions, OnePhotographUnderTwoLedsIsRefusedByNameAndNotWithoutOneOfThem) {
  simulate(scene_named("golden", {48, 32}), session_);
  edit_session([&](Json& s) {
    const fs::path third = session_ / s["shots"][2]["file"].get<std::string>();
    fs::copy_file(session_ / s["shots"][6]["file"].get<std::string>(), third,
                  fs::copy_options::overwrite_existing);
    s["shots"][2]["sha256"] = s["shots"][6]["sha256"];
  });
  expect_refusal(
      work_, {"solve", session_.string(), "--quiet"}, 65,
      {"one photograph is under two LEDs", "06_led07.dng", "of LED 7", "02_led03.dng, of LED 3", "--lights"});
  const Outcome without = run_weft({"solve", session_.string(), "--lights", "1,2,4,5,6,7,8,9,10", "--quiet"});
  EXPECT_EQ(without.exit_code, 0) << without.error;
}

TEST_F(Conditions, CalibrationsShareOfSigmaIsWorkedOutOnAGridAndBlended) {
  simulate(scene_named("golden", {48, 32}), session_);
  const solve::Photographs photographs =
      need(solve::load_photographs(need(solve::plan_session({session_, {}, {}})), {}));
  const Solved solved = solve(photographs);
  ParameterCovariance covariance;
  for (const int led : photographs.leds)
    covariance.parameters.push_back("led" + std::to_string(led) + ".log_flux");
  covariance.matrix.resize(100);
  for (std::size_t i = 0; i < 10; ++i) covariance.matrix[11 * i] = 1e-4;
  const auto sigmas = need(solver::CalibrationSigmas::make(*photographs.field, photographs.size,
                                                           photographs.leds, covariance, {}));
  Image<float> albedo({48, 32});
  for (int y = 0; y < 32; ++y) std::fill_n(albedo.plane().row(y), 48, 0.5f);
  const std::array<View<const float>, 3> normal = {solved.normal.plane(0), solved.normal.plane(1),
                                                   solved.normal.plane(2)};
  Image<float> one({48, 32}, 2), two({48, 32}, 2);
  const Rect band = {0, 0, 48, 32};
  solve::fill_calibration_sigma(sigmas, band, normal, albedo.plane(), {}, 1, one.plane(0), one.plane(1));
  solve::fill_calibration_sigma(sigmas, band, normal, albedo.plane(), {}, 2, two.plane(0), two.plane(1));
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 48; ++x) {
      ASSERT_EQ(one(x, y, 0), two(x, y, 0));
      ASSERT_EQ(one(x, y, 1), two(x, y, 1));
    }
  }
  for (const int y : {0, 16, 31}) {
    for (const int x : {0, 16, 32, 47}) {
      const Vec3 n = {solved.normal(x, y, 0), solved.normal(x, y, 1), solved.normal(x, y, 2)};
      const solver::CalibrationSigma at = sigmas.at(x, y, 1, n, 0.5);
      EXPECT_FLOAT_EQ(one(x, y, 0), static_cast<float>(at.normal_deg)) << x << ' ' << y;
      EXPECT_FLOAT_EQ(one(x, y, 1), static_cast<float>(at.relative_albedo)) << x << ' ' << y;
    }
  }
  EXPECT_FLOAT_EQ(one(8, 16, 0), (one(0, 16, 0) + one(16, 16, 0)) / 2);
  EXPECT_NEAR(one(0, 0, 0), 0.28, 0.15) << "1 percent of each LED";
}

// Dark cloth between two white sheets, behind a lens that spreads one percent of the light.
TEST_F(Conditions, AVeilOverDarkClothIsTakenOff) {
  simulator::Scene scene = scene_named("twill", {160, 96});
  scene.material = {};
  scene.material.albedo.fill(0.04);
  for (const double side : {-1.0, 1.0}) {
    simulator::TargetSettings sheet;
    sheet.pattern = simulator::GreyScaleSettings{
        .reflectances = {0.9}, .patch_mm = 96 * scene.camera.mm_per_pixel, .margin_mm = 0};
    sheet.centre_mm = {side * 80 * scene.camera.mm_per_pixel, 0, 1};
    scene.targets.push_back(sheet);
  }
  scene.camera.veil.share = 0.01;
  scene.effects.veil = scene.effects.noise = true;
  simulate(scene, session_);
  const auto on_cloth = [](int x, int) { return x >= 52 && x < 108; };
  const Solved known = solve(session_);
  const Solved unknown = solve(
      session_, other_calibration([](Calibration& calibration) { calibration.response->veil.reset(); }));
  EXPECT_EQ(known.conditions["veil"], 0.01);
  EXPECT_FALSE(unknown.conditions.contains("veil"));
  const double with_deg = mean_error_deg(known, session_, on_cloth);
  const double without_deg = mean_error_deg(unknown, session_, on_cloth);
  EXPECT_GT(without_deg, 2 * with_deg) << with_deg << " degrees with it taken off";
}

}  // namespace
}  // namespace weft::test
