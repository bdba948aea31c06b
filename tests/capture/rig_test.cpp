// SPDX-License-Identifier: Apache-2.0
#include "capture/rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace weft::capture {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

fs::path rig_file(const std::string& text) {
  const fs::path file = fs::path(testing::TempDir()) / "rig_test.toml";
  std::ofstream(file) << text;
  return file;
}

TEST(RigFile, NeedsNothingButAFile) {
  const auto rig = read_rig(rig_file(""));
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->leds, 10);
  EXPECT_EQ(rig->board.port, "/dev/weft-led");
  EXPECT_EQ(rig->daemon.host, "127.0.0.1");
  EXPECT_EQ(rig->daemon.state, fs::path(testing::TempDir()) / "rig.state");
}

TEST(RigFile, TakesPathsRelativeToItself) {
  const auto rig =
      read_rig(rig_file("name = \"two\"\n"
                        "[camera]\nprofile = \"other.toml\"\n"
                        "[scan]\ncalibration = \"cal\"\nsessions = \"/scans\"\nexposure_us = 20000\n"));
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->scan.calibration, fs::path(testing::TempDir()) / "cal");
  EXPECT_EQ(rig->camera.profile, (fs::path(testing::TempDir()) / "other.toml").string());
  EXPECT_EQ(rig->scan.sessions, "/scans");
  EXPECT_TRUE(rig->scan.copy.empty());
  EXPECT_EQ(rig->scan.exposure_us, 20000);
}

TEST(RigFile, HoldsWhereATapeHasItsLeds) {
  const auto rig =
      read_rig(rig_file("[[led]]\nposition_mm = [0, 300, 400]\n"
                        "[[led]]\nposition_mm = [10, 0, 500]\naim = [0, 0, -2]\nmu = 1.5\n"
                        "[board]\nport = \"/dev/north\"\n"));
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->leds, 2);
  EXPECT_EQ(rig->board.port, "/dev/north");
  ASSERT_TRUE(rig->lights);
  ASSERT_EQ(rig->lights->leds.size(), 2u);
  const NearLight& first = rig->lights->leds[0];
  const NearLight& second = rig->lights->leds[1];
  EXPECT_EQ(first.position_mm, (Vec3{0, 300, 400}));
  EXPECT_NEAR(length(first.aim - Vec3{0, -0.6, -0.8}), 0, 1e-15) << "at the table's centre";
  EXPECT_EQ(first.mu, 1);
  EXPECT_EQ(second.aim, (Vec3{0, 0, -1}));
  EXPECT_EQ(second.mu, 1.5);
}

TEST(RigFile, SaysWhatHangsOnTheBoardBesideTheLeds) {
  const auto plain = read_rig(rig_file(""));
  ASSERT_TRUE(plain) << plain.error().message();
  EXPECT_FALSE(plain->below);
  EXPECT_TRUE(plain->polariser.states.empty());
  const auto rig =
      read_rig(rig_file("[below]\nexposure_us = 9000\n"
                        "[polariser]\nstates = [\"crossed\", \"parallel\"]\nsettle_s = 2\n"));
  ASSERT_TRUE(rig) << rig.error().message();
  ASSERT_TRUE(rig->below);
  EXPECT_EQ(read_rig(rig_file("leds = 6.0\n"))->leds, 6) << "a whole number, however it is written";
  EXPECT_EQ(rig->below->exposure_us, 9000);
  EXPECT_THAT(rig->polariser.states, testing::ElementsAre(Polariser::kCrossed, Polariser::kParallel));
  EXPECT_EQ(rig->polariser.settle_s, 2);
  for (const char* states : {"[\"none\"]", "[\"crossed\", \"crossed\"]",
                             "[\"crossed\", \"parallel\", \"crossed\"]", "[\"skewed\"]"}) {
    const auto wrong = read_rig(rig_file(std::string("[polariser]\nstates = ") + states + "\n"));
    ASSERT_FALSE(wrong) << states;
    EXPECT_THAT(wrong.error().message(), HasSubstr("states"));
  }
}

TEST(RigFile, MayHoldMoreLedsThanABoardHas) {
  std::string text;
  for (int led = 0; led < 12; ++led) text += "[[led]]\nposition_mm = [1, 2, 300]\n";
  const auto rig = read_rig(rig_file(text));
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->lights->leds.size(), 12u);
  EXPECT_EQ(rig->leds, 10);
}

TEST(RigFile, NamesTheKeyThatIsWrong) {
  const struct {
    const char* text;
    const char* key;
  } cases[] = {
      {"lamps = 3", "lamps"},
      {"leds = 11", "leds"},
      {"leds = 2.5", "leds"},
      {"leds = 2\n[[led]]\nposition_mm = [1, 2, 300]", "leds"},
      {"led = 3", "led"},
      {"[[led]]\nposition_mm = [1, 2]", "led 1: position_mm"},
      {"[[led]]\nposition_mm = [1, 2, -300]", "led 1: position_mm"},
      {"[[led]]\nposition_mm = [1, 2, 300]\naim = [0, 0, 0]", "led 1: aim"},
      {"[[led]]\nposition_mm = [1, 2, 300]\nflux = 1", "led 1: flux"},
      {"name = \"a/b\"", "name"},
      {"board = 3", "board"},
      {"[board]\nport = \"\"", "[board]: port"},
      {"[camera]\nport = \"com3\"", "[camera]: port"},
      {"[scan]\nexposure_us = 0", "[scan]: exposure_us"},
      {"[scan]\nsession_name = \"../x\"", "[scan]: session_name"},
      {"[daemon]\nport = 70000", "[daemon]: port"},
      {"[daemon]\nlook_token = \"look\"", "[daemon]: look_token"},
      {"[daemon]\nnames = [\"rig.local:8470\"]", "[daemon]: names"},
      {"[daemon]\norigins = [\"rig.local\"]", "[daemon]: origins"},
      {"[daemon]\npreview = 1", "[daemon]: preview"},
      {"[daemon]\norigins = [\"https://rig.local/\"]", "[daemon]: origins"},
      {"[daemon", "line 1"},
  };
  for (const auto& each : cases) {
    const auto rig = read_rig(rig_file(each.text));
    ASSERT_FALSE(rig) << each.text;
    EXPECT_EQ(rig.error().kind, ErrorKind::kBadData) << each.text;
    EXPECT_THAT(rig.error().where, HasSubstr(each.key)) << each.text;
  }
  EXPECT_EQ(read_rig("/no/such/rig.toml").error().kind, ErrorKind::kNoInput);
}

}  // namespace
}  // namespace weft::capture
