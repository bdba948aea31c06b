// SPDX-License-Identifier: Apache-2.0
// A cloth that was scanned level and once more on a wedge.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/base/json_document.h"
#include "core/rig/session.h"
#include "solve/run/solve_session.h"
#include "tests/system/program.h"
#include "tests/system/session_test.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Level cloth with a narrow lobe: from no LED of ten it is seen to shine.
simulator::Scene shining(double tilt_deg) {
  simulator::Scene scene = scene_named("golden", {192, 128});
  scene.geometry = {};
  scene.material = {};
  scene.material.albedo = {0.4, 0.4, 0.4};
  scene.material.reflectance = simulator::Ggx{.alpha = 0.1, .f0 = {0.04, 0.04, 0.04}};
  scene.effects = {};
  scene.effects.near_light = scene.effects.reflectance = scene.effects.noise = true;
  scene.pose.tilt_deg = tilt_deg;
  return scene;
}

class SecondPose : public testing::Test {
 protected:
  void SetUp() override {
    simulate(shining(0), level_);
    simulate(shining(20), tilted_);
  }
  solve::SolveReport solved(const fs::path& session, const std::string& method,
                            const fs::path& second = {}) const {
    solve::SolveOptions options;
    options.method = method;
    options.second_pose = second;
    const auto report = solve::solve_session({.folder = session, .calibration = {}, .leds = {}}, options, {});
    EXPECT_TRUE(report) << report.error().message();
    return report ? *report : solve::SolveReport();
  }
  Json lobe_of(const solve::SolveReport& report) const {
    const Result<Json> document = read_json(report.folder / "reflectance.json", "weft.reflectance", 1);
    EXPECT_TRUE(document);
    return document ? *document : Json();
  }

  Workspace work_;
  const fs::path level_ = work_ / "level.weft", tilted_ = work_ / "tilted.weft";
};

TEST_F(SecondPose, ShowsTheLobeThatOnePoseDoesNot) {
  const Json alone = lobe_of(solved(level_, "robust"));
  EXPECT_FALSE(alone["clusters"][0]["observable"].get<bool>()) << alone["clusters"][0].dump();
  const solve::SolveReport report = solved(level_, "robust", tilted_);
  const Json both = lobe_of(report);
  ASSERT_TRUE(both["clusters"][0]["observable"].get<bool>()) << both["clusters"][0]["why"];
  EXPECT_TRUE(both["second_pose"].get<bool>());
  EXPECT_NEAR(both["clusters"][0]["alpha"].get<double>(), 0.1, 0.01);
  EXPECT_NEAR(both["clusters"][0]["f0"].get<double>(), 0.04, 0.05 * 0.04);
  EXPECT_TRUE(report.facts.input->second_pose["pose"].contains("tilt_deg"));
}

TEST_F(SecondPose, IsSolvedInTheClothsOwnPlane) {
  simulator::Scene matt = shining(20);
  matt.effects.reflectance = false;
  const fs::path folder = work_ / "matt.weft";
  simulate(matt, folder);
  const Result<Session> session = read_session(folder);
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->pose, (ClothPose{20, 0}));
  const solve::SolveReport report = solved(folder, "least-squares");
  ASSERT_TRUE(report.facts.error);
  EXPECT_LT(report.facts.error->mean_deg, 0.5);
}

TEST_F(SecondPose, IsRefusedInWords) {
  const std::string level = level_.string(), tilted = tilted_.string();
  expect_refusal(work_, {"solve", level, "--second-pose", tilted, "--quality", "fast"}, 64,
                 {"seeks no lobe"});
  expect_refusal(work_, {"solve", level, "--second-pose", level, "--quality", "robust"}, 64, {"other pose"});
  expect_refusal(work_,
                 {"solve", level, "--second-pose", (work_ / "none.weft").string(), "--quality", "robust"}, 66,
                 {"none.weft"});
  Result<Session> session = read_session(tilted_);
  ASSERT_TRUE(session);
  session->pose.tilt_deg = 60;
  ASSERT_TRUE(write_session(*session));
  expect_refusal(work_, {"solve", tilted}, 65, {"tilt_deg", "0 to 45"});
}

}  // namespace
}  // namespace weft::test
