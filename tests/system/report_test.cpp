// SPDX-License-Identifier: Apache-2.0
// What the report of a solve says of scans that went well and of scans that did not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/describe/field_json.h"
#include "core/rig/calibration.h"
#include "simulator/scene/scene.h"
#include "solve/conditions/exposure.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"
#include "solve/photographs/diagnosis_pixels.h"
#include "solve/report/report_page.h"
#include "solve/run/solve_session.h"
#include "solver/diagnosis/diagnosis.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using solver::Diagnosis;
using solver::FaultKind;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// 72 x 54 pixels of a family of plain weave, with every effect that light and cloth have on each other.
simulator::Scene cloth(const std::string& family, const std::string& material, int seed) {
  const bool dark = material == "velvet" || material == "dark-satin";
  const std::string of_material = material == "lambert" ? "albedo = 0.5"
                                  : material == "white" ? "albedo = 0.9"
                                                        : "preset = \"" + material + "\"";
  const std::string toml = "seed = " + std::to_string(seed) +
                           "\n[camera]\nwidth = 72\nheight = 54\nmm_per_pixel = 0.04\nalbedo_at_full = " +
                           (dark ? "0.2" : "0.99") + "\n[geometry]\nfamily = \"" + family +
                           "\"\n[material]\n" + of_material +
                           "\n[effects]\nnear_light = true\nrelief = true\ncast_shadows = true\n"
                           "interreflection = true\nreflectance = true\nled_drift = true\nstray = true\n"
                           "ambient = true\nnoise = true\n";
  Result<simulator::Scene> scene = simulator::parse_scene(toml, "report_test");
  if (!scene) throw std::runtime_error(scene.error().message());
  return *std::move(scene);
}

solver::Evidence evidence_of(const fs::path& session) {
  const Result<solve::SolvePlan> plan =
      solve::plan_session({.folder = session, .calibration = {}, .leds = {}});
  if (!plan) throw std::runtime_error(plan.error().message());
  const Result<solve::Photographs> loaded = solve::load_photographs(*plan, {});
  if (!loaded) throw std::runtime_error(loaded.error().message());
  return solve::read_evidence(*loaded);
}

void swap_photographs(solver::Evidence& evidence, std::size_t a, std::size_t b) {
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    std::swap(evidence.rows[p * evidence.lights + a - 1].reading,
              evidence.rows[p * evidence.lights + b - 1].reading);
  }
}

void scale(solver::Evidence& evidence, std::size_t led, double factor) {
  for (std::size_t p = 0; p < evidence.pixels(); ++p) {
    evidence.rows[p * evidence.lights + led - 1].reading *= factor;
  }
}

class Cloths : public testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  void SetUp() override { simulate(cloth(std::get<0>(GetParam()), std::get<1>(GetParam()), 5), work_ / "c"); }
  Workspace work_;
};

class HealthyCloth : public Cloths {};
TEST_P(HealthyCloth, NamesNoLed) {
  const Diagnosis d = solver::diagnose(evidence_of(work_ / "c"));
  EXPECT_GT(d.pixels, 300U);
  for (const solver::Fault& fault : d.faults) {
    ADD_FAILURE() << "LED " << fault.lights[0] + 1 << " is named, kind " << static_cast<int>(fault.kind)
                  << ", value " << fault.value << ", residual " << fault.residual_before << " to "
                  << fault.residual_after;
  }
}
INSTANTIATE_TEST_SUITE_P(Scenes, HealthyCloth,
                         testing::Combine(testing::Values("smooth", "plain", "deep"),
                                          testing::Values("lambert", "white", "matte-cotton", "satin",
                                                          "velvet", "dark-satin")));

class FaultyScan : public Cloths {};
TEST_P(FaultyScan, NamesWhatIsWrong) {
  const solver::Evidence healthy = evidence_of(work_ / "c");
  solver::Evidence evidence = healthy;
  swap_photographs(evidence, 3, 4);
  Diagnosis d = solver::diagnose(evidence);
  ASSERT_EQ(d.faults.size(), 1U);
  EXPECT_EQ(d.faults[0].kind, FaultKind::kExchanged);
  EXPECT_THAT(d.faults[0].lights, testing::ElementsAre(2, 3));

  swap_photographs(evidence, 6, 9);
  d = solver::diagnose(evidence);
  ASSERT_EQ(d.faults.size(), 2U);
  EXPECT_THAT(d.faults[1].lights, testing::ElementsAre(5, 8));

  evidence = healthy;
  scale(evidence, 5, 0.001);
  d = solver::diagnose(evidence);
  ASSERT_EQ(d.faults.size(), 1U);
  EXPECT_EQ(d.faults[0].kind, FaultKind::kDead);
  EXPECT_THAT(d.faults[0].lights, testing::ElementsAre(4));

  evidence = healthy;
  scale(evidence, 7, 0.96);
  d = solver::diagnose(evidence);
  ASSERT_EQ(d.faults.size(), 1U);
  EXPECT_EQ(d.faults[0].kind, FaultKind::kGain);
  EXPECT_THAT(d.faults[0].lights, testing::ElementsAre(6));
  EXPECT_NEAR(d.faults[0].value, 0.96, 0.012);
}
INSTANTIATE_TEST_SUITE_P(Scenes, FaultyScan,
                         testing::Combine(testing::Values("smooth", "plain", "deep"),
                                          testing::Values("lambert", "white", "matte-cotton", "velvet")));

class Report : public testing::Test {
 protected:
  void SetUp() override { simulate(cloth("plain", "lambert", 1), session_); }
  void swap_leds(int a, int b) {
    edit_json(session_ / "session.json", [&](Json& session) {
      Json *first = nullptr, *second = nullptr;
      for (Json& shot : session["shots"]) {
        if (shot["led"] == a) first = &shot;
        if (shot["led"] == b) second = &shot;
      }
      for (const char* key : {"file", "sha256"}) std::swap((*first)[key], (*second)[key]);
    });
  }
  Json report() const {
    Result<Json> document = read_json(work_ / "maps" / "report.json", "weft.solve-report", 1);
    return document ? *std::move(document) : Json(document.error().message());
  }
  Outcome solve(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"solve", session_.string(), "-o", (work_ / "maps").string(), "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_weft(arguments);
  }
  Workspace work_;
  const fs::path session_ = work_ / "cloth.weft";
};

TEST_F(Report, AloneTellsThatTwoLedsAreSwapped) {
  swap_leds(3, 4);
  const Outcome run = solve();
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const std::string sentence =
      "LEDs 3 and 4 look swapped: with them exchanged the residual of their readings "
      "falls from ";
  EXPECT_THAT(run.error, HasSubstr(sentence));
  const Json document = report();
  ASSERT_EQ(document["faults"].size(), 1U) << document["faults"];
  EXPECT_EQ(document["faults"][0]["kind"], "exchanged");
  EXPECT_EQ(document["faults"][0]["lights"], Json({3, 4}));
  ASSERT_EQ(document["warnings"].size(), 1U) << document["warnings"];
  EXPECT_EQ(document["warnings"][0]["name"], "LEDS_EXCHANGED");
  const std::string page = bytes_of(work_ / "maps" / "report.html");
  EXPECT_THAT(page, HasSubstr(sentence));
  EXPECT_THAT(page, HasSubstr("\"png\":\"iVBORw0KGgo"));
}

TEST_F(Report, WarningsAreAnExitCodeUnderStrict) {
  EXPECT_EQ(solve({"--strict"}).exit_code, 0);
  fs::remove_all(work_ / "maps");
  swap_leds(3, 4);
  EXPECT_EQ(solve({"--strict"}).exit_code, 2);
}

TEST_F(Report, OfAHealthyScanSaysThatNothingStandsOut) {
  ASSERT_EQ(solve({"--no-previews"}).exit_code, 0);
  const Json document = report();
  EXPECT_THAT(document["warnings"], IsEmpty()) << document["warnings"];
  EXPECT_EQ(document["lights"].size(), 10U);
  EXPECT_LT(document["residual"], 0.01);
  EXPECT_GT(document["sigma_normal_deg"]["median"], 0.05);
  EXPECT_LT(document["sigma_normal_deg"]["median"], 1);
  const std::string page = bytes_of(work_ / "maps" / "report.html");
  EXPECT_THAT(page, HasSubstr("Nothing stands out"));
  EXPECT_THAT(page, Not(HasSubstr("\"png\":"))) << "there are no previews";
}

TEST_F(Report, OfPhotographsWithoutANoiseModel) {
  const PhotographSample sample;
  sample.write(work_ / "photos");
  const Outcome run =
      run_weft({"solve", "--photos", (work_ / "photos").string(), "-o", (work_ / "maps").string(), "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.error;
  const Json document = report();
  EXPECT_EQ(document["of"], "photographs");
  EXPECT_THAT(document["warnings"], IsEmpty()) << document["warnings"];
  EXPECT_THAT(bytes_of(work_ / "maps" / "report.html"), HasSubstr("Light 6"));
}

TEST(MapSummary, CountsTheShareOfTheClothThatHasANormal) {
  Image<std::uint16_t> status({10, 1});
  for (int x = 4; x < 8; ++x) status(x, 0) = kSaturated | kNoSolution;
  for (int x = 8; x < 10; ++x) status(x, 0) = kInvalidReading | kNoSolution;  // outside a mask: no cloth
  solve::MapSummary maps({10, 1}), none({10, 1});
  solve::MapBand band;
  band.status = status.plane();
  maps.add(band, {});
  EXPECT_DOUBLE_EQ(maps.expected().solved, 0.5);
  EXPECT_NEAR(maps.expected().total_deg, 180 / std::numbers::pi, 1e-12) << "no angle is known";
  EXPECT_NEAR(maps.expected().of_whole_deg(), 180 / std::numbers::pi, 1e-12);
  EXPECT_EQ(none.expected().solved, 0);
  EXPECT_EQ(error_in_words(0, 0), "nothing solved");
  EXPECT_EQ(error_in_words(0.248, 0.108), "0.248 degrees on 11 % of the cloth");
  EXPECT_EQ(share_in_words(0.9999), "over 99 %");
  EXPECT_EQ(share_in_words(1), "100 %");
}

TEST(MapSummary, FindsQuantilesOfSigmaAndOfItsPartsWhereTheNormalIsKnown) {
  constexpr int kWidth = 1000;
  Image<float> noise({kWidth, 1}), model({kWidth, 1}), calibration({kWidth, 1}), sum({kWidth, 1});
  for (int x = 0; x < kWidth; ++x) {
    noise(x, 0) = 0.001F * static_cast<float>(x + 1);
    model(x, 0) = 0.002F * static_cast<float>(x + 1);
    calibration(x, 0) = 0.01F * static_cast<float>(x + 1);
    sum(x, 0) = 0.02F * static_cast<float>(x + 1);
  }
  for (int x = 800; x < kWidth; ++x) sum(x, 0) = 180;  // without a normal
  solve::MapSummary with({kWidth, 1}), without({kWidth, 1});
  solve::MapBand band;
  band.albedo_rows = {0, 0, kWidth, 1};
  band.sigma_normal_deg = noise.plane();
  band.model_normal_deg = model.plane();
  with.add(band, sum.plane(), calibration.plane());
  without.add(band, sum.plane());
  EXPECT_NEAR(with.sigma_map().median, 8, 0.08);
  EXPECT_NEAR(with.sigma_facts().noise->median, 0.4, 0.004);
  const SigmaFacts facts = with.sigma_facts();
  ASSERT_TRUE(facts.model && facts.calibration);
  EXPECT_NEAR(facts.model->median, 0.8, 0.008);
  EXPECT_NEAR(facts.calibration->median, 4, 0.04);
  EXPECT_NEAR(facts.calibration->p95, 7.6, 0.076);
  EXPECT_EQ(without.sigma_map().grid, with.sigma_map().grid);
  EXPECT_EQ(facts.median, with.sigma_map().median);
  EXPECT_FALSE(without.sigma_facts().calibration);
}

TEST(Budget, NamesTheModelAndTheCalibrationWhereItHasACovariance) {
  Workspace work;
  simulate(cloth("plain", "lambert", 5), work / "c");
  Result<solve::SolvePlan> plan = solve::plan_session({.folder = work / "c", .calibration = {}, .leds = {}});
  ASSERT_TRUE(plan) << plan.error().message();
  Calibration known = plan->calibration;
  known.light_covariance = ParameterCovariance{};
  for (int led = 1; led <= 10; ++led) {
    known.light_covariance->parameters.push_back("led" + std::to_string(led) + ".log_flux");
  }
  known.light_covariance->matrix.resize(100);
  for (std::size_t i = 0; i < 10; ++i) known.light_covariance->matrix[11 * i] = 1e-4;
  const Result<Calibration> written = write_calibration(work / "known", std::move(known));
  ASSERT_TRUE(written) << written.error().message();

  solve::SolveOptions options;
  options.previews = false;
  options.output = work / "maps";
  const Result<solve::SolveReport> solved =
      solve::solve_session({.folder = work / "c", .calibration = work / "known", .leds = {}}, options, {});
  ASSERT_TRUE(solved) << solved.error().message();
  const Json report = Json::parse(bytes_of(work / "maps" / "report.json"));
  const double median_deg = report["sigma_calibration_deg"]["median"];
  EXPECT_NEAR(median_deg, 0.28, 0.15) << "1 percent of each LED";
  const Json parts = Json::parse(bytes_of(work / "maps" / "solve.json"))["sigma_normal_deg"];
  for (const auto& [source, part] : {std::pair{"photon and read noise", "noise"},
                                     {"what the model leaves out", "model"},
                                     {"calibration", "calibration"}}) {
    const auto row = std::find_if(report["budget"].begin(), report["budget"].end(),
                                  [&, name = source](const Json& each) { return each["source"] == name; });
    ASSERT_NE(row, report["budget"].end()) << source << report["budget"];
    EXPECT_EQ((*row)["value"], report[std::string("sigma_") + part + "_deg"]["median"]) << source;
    EXPECT_EQ((*row)["value"], parts[part]["median"]) << source;
    EXPECT_EQ((*row)["unit"], "deg");
  }
  EXPECT_THAT(bytes_of(work / "maps" / "report.html"), HasSubstr("[\"calibration\\n"));
}

// Ten shots of which the fifth has moved, at a cost.
solve::PhotographsSummary moved_summary(double cost_deg) {
  solve::PhotographsSummary summary;
  for (int k = 1; k <= 10; ++k) summary.numbers.push_back(k);
  summary.shifts.shots.resize(10);
  summary.shifts.shots[4].verdict = solve::ShiftVerdict::kFlagged;
  summary.shifts.shots[4].measured.cost_deg = cost_deg;
  return summary;
}

TEST(Verdicts, WarnOfAClothThatMovedWhereItCostsADegreeAndNotWhereATenth) {
  EXPECT_THAT(solve::verdicts_of(moved_summary(0.15), 0, {}, {}), IsEmpty());
  const std::vector<Verdict> verdicts = solve::verdicts_of(moved_summary(1.1), 0, {}, {});
  ASSERT_EQ(verdicts.size(), 1U);
  EXPECT_EQ(verdicts[0].name, "CLOTH_MOVED");
  EXPECT_THAT(verdicts[0].text, testing::HasSubstr("LED 5"));
  EXPECT_THAT(verdicts[0].remedy, testing::HasSubstr("scan again"));
}

// Ten shots that cannot be registered and deviate.
solve::PhotographsSummary unregistered_summary(double residual) {
  solve::PhotographsSummary summary = moved_summary(1.1);
  summary.shifts.found = false;
  summary.diagnosis.residual = residual;
  summary.far_shifts = solve::MovedShots{{}, 0, 0, 128};
  return summary;
}

TEST(Verdicts, NameNoCauseOfReadingsThatDoNotFitUnlessOneWasFound) {
  EXPECT_THAT(solve::verdicts_of(unregistered_summary(0.004), 0, {}, {}), IsEmpty());
  solve::PhotographsSummary summary = unregistered_summary(0.09);
  std::vector<Verdict> verdicts = solve::verdicts_of(summary, 0, {}, solver::Level::kStandard);
  ASSERT_EQ(verdicts.size(), 1U);
  EXPECT_EQ(verdicts[0].name, "READINGS_DO_NOT_FIT");
  EXPECT_THAT(verdicts[0].text, HasSubstr("by 9 percent"));
  EXPECT_THAT(verdicts[0].text, HasSubstr("a cloth that moved by up to 128 pixels"));
  EXPECT_THAT(verdicts[0].remedy, HasSubstr("--quality robust"));
  summary.diagnosis.residual = 5.62;
  summary.of_session = false;
  verdicts = solve::verdicts_of(summary, 0, {}, solver::Level::kRobust);
  EXPECT_THAT(verdicts.at(0).text, HasSubstr("by over 100 percent"));
  EXPECT_THAT(verdicts.at(0).remedy, HasSubstr("--transfer"));
  EXPECT_THAT(verdicts.at(0).remedy, Not(HasSubstr("robust")));
  const LeftOutFacts unfit = {{.median = 0.2, .rms = 0.3, .readings = 100}, {}};
  verdicts = solve::verdicts_of(summary, 0, unfit, solver::Level::kStandard);
  ASSERT_EQ(verdicts.size(), 1U);
  EXPECT_EQ(verdicts[0].name, "LIGHTS_DO_NOT_FIT") << "what left-out light says is said";
}

TEST(Verdicts, SayThatTheClothMovedWhereAFarShiftExplainsIt) {
  solve::PhotographsSummary summary = unregistered_summary(0.09);
  summary.far_shifts = solve::MovedShots{{6, 7, 8, 9}, 23.4, 0.84, 128};
  const std::vector<Verdict> verdicts = solve::verdicts_of(summary, 0, {}, solver::Level::kStandard);
  ASSERT_EQ(verdicts.size(), 1U);
  EXPECT_EQ(verdicts[0].name, "CLOTH_MOVED");
  EXPECT_THAT(verdicts[0].text, HasSubstr("LEDs 7, 8, 9 and 10 it lies up to 23 pixels"));
  EXPECT_THAT(verdicts[0].text, HasSubstr("84 percent"));
  EXPECT_THAT(verdicts[0].remedy, HasSubstr("--lights 1,2,3,4,5,6"));
  summary.far_shifts->moved = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_THAT(solve::verdicts_of(summary, 0, {}, {}).at(0).remedy, Not(HasSubstr("--lights")))
      << "three are left";
}

TEST(Verdicts, SayOfGlossThatItShinesAndNotThatItMoved) {
  solve::PhotographsSummary summary = unregistered_summary(0.11);
  summary.glossy_share = 0.9;  // solved with its lobe
  EXPECT_THAT(solve::verdicts_of(summary, 0, {}, {}), IsEmpty());
  summary.glossy_share = 0;
  summary.outshining = 1;
  const std::vector<Verdict> dominated = solve::verdicts_of(summary, 0.5, {}, {});
  ASSERT_EQ(dominated.size(), 1U);
  EXPECT_EQ(dominated[0].name, "SPECULAR_DOMINATED");
}

TEST(Verdicts, OfPhotographsSpeakOfNoScan) {
  solve::PhotographsSummary summary = moved_summary(1.1);
  summary.of_session = false;
  summary.outshining = 1;
  summary.shadow_reach_is_capped = true;
  summary.diagnosis.faults = {{FaultKind::kDead, {1}, {}},
                              {FaultKind::kExchanged, {2, 3}, {3, 2}},
                              {FaultKind::kGain, {5}, {}, 0.5, 0, 0, 0, 3}};
  for (const Verdict& verdict : solve::verdicts_of(summary, 0.5, {}, solver::Level::kStandard)) {
    for (const char* word : {"scan", "wiring", "cable", "calibrat"})
      EXPECT_THAT(verdict.remedy, Not(HasSubstr(word))) << verdict.name;
  }
}

TEST(ExposureVerdict, TellsOverAndDarkPhotographsFromGoodOnes) {
  const solve::Fullness good = {.full = 0.02, .missing = 0, .lit = 0.98, .brightest = 0.8};
  EXPECT_FALSE(solve::exposure_verdict(good, 0.001, 3, true)) << "a dark weave is noisy in a good exposure";
  const solve::Fullness over = {.full = 0.97, .missing = 0, .lit = 0.03, .brightest = 1};
  const std::optional<Verdict> too_long = solve::exposure_verdict(over, 0.89, 0.2, true);
  ASSERT_TRUE(too_long);
  EXPECT_EQ(too_long->name, "OVEREXPOSED");
  EXPECT_THAT(too_long->text, HasSubstr("97 percent of the readings are full"));
  EXPECT_THAT(too_long->text, HasSubstr("89 percent of the picture has no solution"));
  const solve::Fullness dark = {.full = 0, .missing = 0, .lit = 0.9, .brightest = 0.026};
  const std::optional<Verdict> too_short = solve::exposure_verdict(dark, 0, 5.1, true);
  ASSERT_TRUE(too_short);
  EXPECT_EQ(too_short->name, "UNDEREXPOSED");
  EXPECT_THAT(too_short->text, HasSubstr("2.6 percent of white"));
  EXPECT_FALSE(solve::exposure_verdict(dark, 0, 0.4, true)) << "noise does no harm";
}

TEST(Verdicts, WarnOfShadowsFromFartherThanTheyAreLookedFor) {
  solve::PhotographsSummary summary;
  summary.shadow_reach_is_capped = true;
  ASSERT_EQ(solve::verdicts_of(summary, 0, {}, {}).size(), 1U);
  EXPECT_EQ(solve::verdicts_of(summary, 0, {}, {})[0].name, "SHADOWS_CAPPED");
}

TEST(Verdicts, CallAClothDominatedByHighlightsFromAFifthOfThePixels) {
  solve::PhotographsSummary glossy;
  glossy.outshining = 0.3;
  EXPECT_THAT(solve::verdicts_of(glossy, 0.2, {}, solver::Level::kStandard), IsEmpty());
  const std::vector<Verdict> verdicts = solve::verdicts_of(glossy, 0.21, {}, solver::Level::kStandard);
  ASSERT_EQ(verdicts.size(), 1U);
  EXPECT_EQ(verdicts[0].name, "SPECULAR_DOMINATED");
  EXPECT_THAT(verdicts[0].text, HasSubstr("21 percent"));
  EXPECT_THAT(verdicts[0].remedy, HasSubstr("crossed polarisers"));
}

TEST(Verdicts, RecommendNoLevelThatHasRun) {
  const LeftOutFacts unfit = {{.median = 0.2, .rms = 0.3, .readings = 100}, {}};
  solve::PhotographsSummary glossy;
  glossy.outshining = 1;
  for (const solver::Level level :
       {solver::Level::kStandard, solver::Level::kRobust, solver::Level::kReference}) {
    const std::vector<Verdict> verdicts = solve::verdicts_of(glossy, 0.5, unfit, level);
    ASSERT_EQ(verdicts.size(), 2U);
    for (const Verdict& verdict : verdicts) {
      EXPECT_EQ(verdict.remedy.find("--quality robust") != std::string::npos, level < solver::Level::kRobust)
          << verdict.remedy;
    }
  }
}

TEST(Verdicts, SayThatLightsDoNotFitFromATenthAndThreeTimesTheNoise) {
  const auto names = [](double median, std::optional<double> noise) {
    const LeftOutFacts facts = {{.median = median, .noise_median = noise}, {}};
    std::vector<std::string> all;
    for (const Verdict& verdict : solve::verdicts_of({}, 0, facts, solver::Level::kStandard))
      all.push_back(verdict.name);
    return all;
  };
  EXPECT_THAT(names(0.09, {}), IsEmpty());
  EXPECT_THAT(names(0.11, {}), testing::ElementsAre("LIGHTS_DO_NOT_FIT"));
  EXPECT_THAT(names(0.11, 0.03), testing::ElementsAre("LIGHTS_DO_NOT_FIT"));
  EXPECT_THAT(names(0.11, 0.04), IsEmpty()) << "a dark cloth";
}

std::string page_of(Json report, const std::vector<report::Figure>& pictures = {}) {
  report.update({{"of", "session"},
                 {"id", "0123456789abcdef"},
                 {"method", "standard"},
                 {"width", 8},
                 {"height", 8},
                 {"albedo_scale", "absolute"},
                 {"pixels", 64}});
  const Result<solve::SolveReportFacts> facts = read_fields<solve::SolveReportFacts>(report, "report");
  EXPECT_TRUE(facts) << facts.error().message();
  return facts ? solve::report_page(*facts, pictures) : "";
}

TEST(ReportPage, SaysHowWellLeftOutLightsArePredictedAndWhatThatCannotSee) {
  Json report = {{"title", "twill"},         {"of", "session"},          {"warnings", Json::array()},
                 {"status", Json::object()}, {"lights", Json::array()},  {"faults", Json::array()},
                 {"budget", Json::array()},  {"seconds", Json::object()}};
  report["sigma_normal_deg"]["median"] = nullptr;
  report["check"] =
      object_of(LeftOutFacts{{0.0123, 0.02, 0.0111, 0.015, 90}, {{4, {0.04, 0.06, {}, {}, 12}}}});
  const std::string page = page_of(report);
  EXPECT_THAT(page, HasSubstr("1.23 %"));
  EXPECT_THAT(page, HasSubstr("1.11 %"));
  EXPECT_THAT(page, HasSubstr("LED 4"));
  EXPECT_THAT(page, HasSubstr(kLeftOutBlindSpot));
}

TEST(ReportPage, SaysBelowWhichAnglesNinetyFivePercentAre) {
  const Json report = {
      {"title", "twill"},
      {"warnings", Json::array()},
      {"status", Json::object()},
      {"lights", Json::array()},
      {"faults", Json::array()},
      {"budget", Json::array()},
      {"sigma_normal_deg",
       {{"median", 0.25}, {"p95", 0.5}, {"solved", 0.11}, {"columns", 1}, {"rows", 1}, {"grid", {0.25}}}},
      {"seconds", Json::object()},
      {"error", {{"mean_deg", 1.5}, {"median_deg", 1}, {"p95_deg", 3.25}, {"max_deg", 9}}}};
  const std::string page = page_of(report);
  EXPECT_THAT(page, HasSubstr("Median 0.25°, 95 percent below 0.5°. Both hold for the 11 % of the cloth"));
  EXPECT_THAT(page, HasSubstr("mean error against the truth; 95 percent below 3.25°"));
}

TEST(ReportPage, LeavesOutWhatIsNotThereAndEscapesWhatIs) {
  const Json report = {{"schema", "weft.solve-report/1"}, {"title", "wool & <b>silk</b>"},
                       {"warnings", Json::array()},       {"status", {{"SHADOWED", 0.25}}},
                       {"lights", Json::array()},         {"faults", Json::array()},
                       {"budget", Json::array()},         {"sigma_normal_deg", {{"median", nullptr}}},
                       {"seconds", {{"read", 1.5}}}};
  const std::string page = page_of(report);
  EXPECT_THAT(page, HasSubstr("wool &amp; &lt;b&gt;silk&lt;/b&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
  EXPECT_THAT(page, HasSubstr("25.0 %"));
  EXPECT_THAT(page, HasSubstr("1.50 s"));
  EXPECT_THAT(page, Not(HasSubstr("Gates")));
  EXPECT_THAT(page, Not(HasSubstr("Conditions")));
  EXPECT_THAT(page_of(report, {{"a", report::Png{"Ma"}}}), HasSubstr("TWE="));
}

}  // namespace
}  // namespace weft::test
