// SPDX-License-Identifier: Apache-2.0
// Which light a rig should have for a cloth, as a person asks.
#include "calibration/guide/rig_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/rig/calibration.h"
#include "simulator/reflectance/presets.h"
#include "tests/system/samples.h"
#include "tests/system/workspace.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;
using test::expect_refusal;
using test::run_weft;
using test::source_file;
using testing::HasSubstr;
using testing::Not;

using Words = std::vector<std::string>;

std::string ten_leds() {
  return source_file("testdata/golden/satin.weft/calibration").string();
}

class RigPlan : public testing::Test {
 protected:
  Json plan(const std::string& rig, const Words& more = {}) const {
    Words words = {"rig", "plan", rig, "--json", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    return run_weft(words).json();
  }
  std::string rig_file(const std::string& text) const {
    test::put_bytes(work_ / "rig.toml", text);
    return (work_ / "rig.toml").string();
  }
  std::string three_leds() const {
    return rig_file(
        "name = \"tape\"\n[[led]]\nposition_mm = [0, 380, 420]\n[[led]]\nposition_mm = [380, -100, 420]\n"
        "[[led]]\nposition_mm = [-380, -100, 420]\n");
  }
  const Words with(const Words& more) const {
    Words words = {"rig", "plan", ten_leds(), "-q"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  test::Workspace work_;
};

const Json& row_named(const Json& plan, const std::string& name) {
  for (const Json& row : plan.at("rows")) {
    if (row.at("name") == name) return row;
  }
  ADD_FAILURE() << "no " << name << " in " << plan;
  return plan.at("rows")[0];
}

double normal_of(const Json& row) {
  return row.at("sigma").at("normal_deg").get<double>();
}

TEST_F(RigPlan, SaysWhatEachLightTellsAndCosts) {
  const Json plan = this->plan(ten_leds(), {"--cloth", "velvet", "--pace", "5"});
  EXPECT_EQ(plan.at("rig"), "virtual rig");
  EXPECT_EQ(plan.at("leds"), 10);
  const Json& today = row_named(plan, "as-it-is");
  const std::map<std::string, int> shots = {{"as-it-is", 0},    {"one-more", 1},
                                            {"near-camera", 1}, {"polarisers", 10},
                                            {"moved", 0},       {"polarisers-near-camera", 12}};
  EXPECT_EQ(plan["rows"].size(), shots.size());
  for (const auto& [name, extra] : shots) {
    const Json& row = row_named(plan, name);
    EXPECT_EQ(row.at("extra_shots"), extra) << name;
    EXPECT_GE(row.at("extra_seconds").get<double>(), 5 * extra) << name;
    EXPECT_NEAR(row.at("degrees_won").get<double>(), normal_of(today) - normal_of(row), 1e-12) << name;
    for (const char* key : {"normal_deg", "alpha", "sheen"}) {
      EXPECT_LE(row.at("least_sigma").at(key).get<double>(), row.at("sigma").at(key).get<double>()) << name;
    }
  }
  EXPECT_GT(row_named(plan, "polarisers").at("extra_seconds").get<double>(), 50) << "films take light";
  EXPECT_GT(row_named(plan, "moved").at("led").get<int>(), 0);
  EXPECT_NEAR(row_named(plan, "near-camera").at("place").at("from_camera_deg").get<double>(), 8, 1e-9);
  EXPECT_FALSE(plan.at("observable").get<bool>());
  EXPECT_TRUE(row_named(plan, "polarisers").at("observable").get<bool>());
  EXPECT_THAT(plan.at("verdict").get<std::string>(), HasSubstr("what makes it so"));
}

TEST_F(RigPlan, IsATableForPeople) {
  const std::string table = run_weft({"rig", "plan", three_leds(), "--cloth", "satin", "-q"}).output;
  for (const char* words :
       {"satin under the 3 LEDs of tape", "observable", "one more LED", "polarisers",
        "not observable with the LEDs as they are; what makes them so", "known to 1 mm"}) {
    EXPECT_THAT(table, HasSubstr(words));
  }
  EXPECT_THAT(table, HasSubstr("     -°        -        -  no")) << "three readings tell no lobe";
  EXPECT_THAT(table, Not(HasSubstr("nan")));
  EXPECT_THAT(table, Not(HasSubstr("inf")));
}

TEST_F(RigPlan, OfAMattClothHasNormalsAlone) {
  const Json plan = this->plan(three_leds(), {"--cloth", "cotton"});
  EXPECT_FALSE(plan["rows"][0]["sigma"].contains("alpha"));
  EXPECT_LT(normal_of(plan["rows"][0]), 2);
  EXPECT_THAT(plan.at("verdict").get<std::string>(), HasSubstr("matt"));
}

TEST_F(RigPlan, TakesTheLobeThatASolveFound) {
  const std::string file = source_file("testdata/schemas/weft.reflectance-1/reflectance.json").string();
  const Json cloth = plan(three_leds(), {"--reflectance", file, "--albedo", "0.2"}).at("cloth");
  const Json found = Json::parse(test::bytes_of(file)).at("clusters").at(0);
  ASSERT_EQ(found.at("family"), "anisotropic-ggx");
  for (const char* key : {"family", "alpha", "f0", "weft_share"})
    EXPECT_EQ(cloth.at(key), found.at(key)) << key;
  EXPECT_NEAR(cloth.at("alpha_along").get<double>(), found.at("alpha_along").get<double>(), 1e-12);
  EXPECT_EQ(cloth.at("albedo"), 0.2);

  const fs::path relative = work_ / "relative.json";
  fs::copy_file(file, relative);
  test::edit_json(relative, [](Json& document) {
    document["clusters"][0].erase("f0");
    document["clusters"][0]["f0_over_albedo"] = 0.25;
  });
  const Json other = plan(three_leds(), {"--reflectance", relative.string(), "--albedo", "0.2"}).at("cloth");
  EXPECT_NEAR(other.at("f0").get<double>(), 0.05, 1e-12);
}

TEST_F(RigPlan, TakesTwoLobesThatASolveFound) {
  const std::string file = source_file("testdata/schemas/weft.reflectance-1.2/reflectance.json").string();
  const Json plan = this->plan(three_leds(), {"--reflectance", file, "--albedo", "0.06"});
  const Json found = Json::parse(test::bytes_of(file)).at("clusters").at(0);
  ASSERT_EQ(found.at("family"), "two-ggx");
  for (const char* key : {"family", "alpha", "alpha_broad", "broad_share", "f0"})
    EXPECT_EQ(plan.at("cloth").at(key), found.at(key)) << key;
}

TEST_F(RigPlan, ReadsTheCalibrationThatARigFileNames) {
  const std::string file = rig_file("[scan]\ncalibration = \"" + ten_leds() + "\"\n");
  const Json plan = this->plan(file);
  EXPECT_EQ(plan.at("leds"), 10);
  EXPECT_EQ(plan.at("rig"), "virtual rig");
  EXPECT_NEAR(plan.at("full_well_electrons").get<double>(), 40000, 500) << "2.52 electrons a count";
}

TEST_F(RigPlan, CountsWhatACalibrationSaysOfItsLeds) {
  Result<Calibration> calibration = read_calibration(ten_leds());
  ASSERT_TRUE(calibration) << calibration.error().message();
  ParameterCovariance covariance;
  for (int led = 1; led <= 10; ++led)
    covariance.parameters.push_back("led" + std::string(led < 10 ? "0" : "") + std::to_string(led) +
                                    ".log_flux");
  covariance.matrix.assign(100, 0);
  for (std::size_t i = 0; i < 10; ++i) covariance.matrix[11 * i] = 4e-4;
  calibration->light_covariance = covariance;
  const Result<Calibration> written = write_calibration(work_ / "vague", *calibration);
  ASSERT_TRUE(written) << written.error().message();
  const Json vague = plan((work_ / "vague").string()), typical = plan(ten_leds());
  EXPECT_EQ(vague.at("rig_errors"), "calibration");
  EXPECT_EQ(typical.at("rig_errors"), "typical");
  EXPECT_GT(normal_of(vague["rows"][0]), 1.5 * normal_of(typical["rows"][0])) << "fluxes to 2 percent";
}

TEST_F(RigPlan, DrawsTheHemisphere) {
  const fs::path picture = work_ / "plan.svg";
  ASSERT_EQ(run_weft(with({"--picture", picture.string()})).exit_code, 0);
  const std::string drawing = test::bytes_of(picture);
  EXPECT_TRUE(drawing.starts_with("<svg")) << drawing.substr(0, 80);
  EXPECT_THAT(drawing, HasSubstr(">10</text>"));
  EXPECT_THAT(drawing, HasSubstr("degrees of the normal won"));
  const fs::path dark = work_ / "dark.svg";
  ASSERT_EQ(run_weft({"rig", "plan", three_leds(), "-q", "--picture", dark.string()}).exit_code, 0);
  EXPECT_THAT(test::bytes_of(dark), HasSubstr("sigma of the normal")) << "nothing to win from";
}

TEST_F(RigPlan, IsTheSameForAnyNumberOfThreads) {
  EXPECT_EQ(plan(three_leds(), {"--threads", "1"}), plan(three_leds(), {"--threads", "3"}));
}

TEST_F(RigPlan, RefusesARigWhoseLightsHaveNoPlaces) {
  const std::string distant = source_file("testdata/schemas/weft.calibration-1-distant").string();
  expect_refusal(work_, {"rig", "plan", distant, "-q"}, 65, {"no lights to plan with", "distant", "[[led]]"});
  expect_refusal(work_, {"rig", "plan", rig_file("name = \"bare\"\n"), "-q"}, 65,
                 {"no [[led]]", "calibrate"});
  expect_refusal(work_, {"rig", "plan", (work_ / "nowhere").string(), "-q"}, 66, {"nowhere", "No such file"});
  const std::string low = rig_file("[[led]]\nposition_mm = [0, 0, 5]\n");
  expect_refusal(work_, {"rig", "plan", low, "-q"}, 65, {"LED 1 is 5 mm from the cloth"});
}

TEST_F(RigPlan, RefusesAClothThatIsNone) {
  const fs::path file = work_ / "reflectance.json";
  fs::copy_file(source_file("testdata/schemas/weft.reflectance-1/reflectance.json"), file);
  const auto refuse = [&](const Words& words) {
    expect_refusal(work_, with({"--reflectance", file.string()}), 65, words);
  };
  test::edit_json(file, [](Json& document) { document["clusters"][0]["alpha"] = 7; });
  refuse({"no lobe to plan for", "roughness"});
  test::edit_json(file, [](Json& document) { document["clusters"][0]["family"] = "hair"; });
  refuse({"hair"});
  test::edit_json(file, [](Json& document) { document["clusters"][0].erase("alpha"); });
  refuse({"alpha"});
  test::edit_json(file, [](Json& document) { document["clusters"][0]["observable"] = false; });
  refuse({"nothing observable", "--cloth"});
  test::edit_json(file, [](Json& document) { document["clusters"] = Json::array({nullptr}); });
  refuse({"cluster 0", "observable"});
  test::put_bytes(file, "{");
  refuse({"not valid JSON"});
}

TEST_F(RigPlan, RefusesWordsThatDoNotFitTogether) {
  for (const Words& words : {Words{"--f0", "0.04"},
                             {"--cloth", "silk"},
                             {"--roughness", "3"},
                             {"--roughness", "0.3", "--cloth", "satin"},
                             {"--relief", "80"},
                             {"--albedo", "0"}}) {
    expect_refusal(work_, with(words), 64, {words.front()});
  }
  expect_refusal(work_, with({"--picture", (work_ / "plan.png").string()}), 64, {"plan.png", ".svg"});
  const std::string rig = three_leds();
  expect_refusal(work_, {"rig", "plan", rig, "-q", "--picture", (work_ / "no" / "plan.svg").string()}, 73,
                 {"plan.svg"});
}

// The solver's cloths are written apart from the simulator's.
TEST(PlannedCloths, AreThoseThatTheSimulatorHas) {
  for (const NamedCloth& each : planned_cloths()) {
    const auto preset = simulator::preset(each.name == "cotton" ? "matte-cotton" : each.name);
    ASSERT_TRUE(preset) << each.name;
    const solver::Lobe& lobe = each.cloth.lobe;
    EXPECT_EQ(each.cloth.albedo, preset->albedo[1]) << each.name;
    if (const auto* satin = std::get_if<simulator::AnisotropicGgx>(&preset->reflectance)) {
      EXPECT_EQ(lobe.family, solver::LobeFamily::kAnisotropicGgx) << each.name;
      EXPECT_EQ(lobe.alpha, satin->alpha) << each.name;
      EXPECT_NEAR(lobe.along, 1 - satin->anisotropy, 1e-12) << each.name;
      EXPECT_EQ(lobe.f0, satin->f0[1]) << each.name;
    } else if (const auto* pile = std::get_if<simulator::Cloth>(&preset->reflectance)) {
      EXPECT_EQ(lobe.family, solver::LobeFamily::kCloth) << each.name;
      EXPECT_EQ(lobe.alpha, pile->alpha) << each.name;
      EXPECT_EQ(lobe.f0, pile->f0[1]) << each.name;
    } else {
      EXPECT_FALSE(lobe.shines()) << each.name;
    }
  }
}

}  // namespace
}  // namespace weft::calibration
