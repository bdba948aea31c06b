// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/rig_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core/base/files.h"
#include "core/rig/calibration.h"
#include "tests/virtual_rig/small_scene.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

RigFolder taken(const fs::path& folder, bool keep_log = false) {
  Result<RigFolder> taken = RigFolder::take(folder, keep_log);
  if (!taken) throw std::runtime_error(taken.error().message());
  return std::move(*taken);
}

TEST(RigFolder, TellsAHostWhereItsDevicesAre) {
  const fs::path folder = fresh_folder() / "rig";
  simulator::Scene scene = small_scene();
  scene.geometry.cloth_height_mm = 1.5;
  const Result<LightFrames> frames = LightFrames::open(scene, folder.parent_path() / "cache");
  ASSERT_TRUE(frames) << frames.error().message();
  const RigFolder rig = taken(folder);
  const Result<simulator::BareRig> bare = simulator::BareRig::of(scene);
  ASSERT_TRUE(bare) << bare.error().message();
  const Result<void> written =
      rig.write(*frames, *bare, {"/dev/../a \"b\"", "ptpip:127.0.0.1:7:7", "6000042", {"A=1", "B=2"}});
  ASSERT_TRUE(written) << written.error().message();

  const std::string toml = read_text(folder / "rig.toml").value();
  for (const char* line :
       {"leds = 3", "port = \"/dev/../a \\\"b\\\"\"", "port = \"ptpip:127.0.0.1:7:7\"",
        "serial = \"6000042\"", "cloth_height_mm = 1.5", "virtual_control = \"control\""}) {
    EXPECT_THAT(toml, HasSubstr(line));
  }
  EXPECT_EQ(read_text(folder / "environment").value(), "A=1\nB=2\n");
  EXPECT_TRUE(is_there(folder / "home"));
  const Result<Calibration> calibration = read_calibration(folder / "calibration");
  ASSERT_TRUE(calibration) << calibration.error().message();
  EXPECT_EQ(calibration->subject.camera_serial, "6000042");
  EXPECT_EQ(calibration->subject.camera_model, "D5100");
  EXPECT_EQ(light_count(*calibration->lights), 3u);
}

TEST(RigFolder, OfABareRigHasATapesLedsAndWhatIsWrittenAboutThings) {
  const fs::path folder = fresh_folder() / "rig";
  const simulator::Scene scene = small_scene();
  const Result<LightFrames> frames = LightFrames::open(scene, folder.parent_path() / "cache");
  ASSERT_TRUE(frames) << frames.error().message();
  const RigFolder rig = taken(folder);
  RigFiles files;
  files.is_bare = true;
  const Result<simulator::BareRig> bare = simulator::BareRig::of(scene);
  ASSERT_TRUE(bare) << bare.error().message();
  ASSERT_TRUE(rig.write(*frames, *bare, files));

  EXPECT_THAT(read_text(folder / "rig.toml").value(), HasSubstr("[[led]]\nposition_mm = ["));
  const Result<Calibration> calibration = read_calibration(folder / "calibration");
  ASSERT_TRUE(calibration) << calibration.error().message();
  const auto& lights = std::get<NearLights>(*calibration->lights);
  for (std::size_t k = 0; k < lights.leds.size(); ++k) {
    const Vec3 off = lights.leds[k].position_mm - frames->rig().leds.leds[k].position_mm;
    EXPECT_NEAR(length(off), 10, 1e-9) << "LED " << k + 1;
  }
  for (const char* name : {"board.toml", "sheet.toml", "scale.toml"})
    EXPECT_TRUE(is_there(folder / "targets" / name)) << name;
}

TEST(RigFolder, BelongsToOneRigAtATime) {
  const fs::path folder = fresh_folder() / "rig";
  const RigFolder rig = taken(folder);
  const Result<RigFolder> second = RigFolder::take(folder, false);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, ErrorKind::kTryAgain);
}

TEST(RigFolder, IsGoneAtTheEnd) {
  const fs::path folder = fresh_folder() / "rig";
  {
    const RigFolder rig = taken(folder);
    std::ofstream(folder / "rig.toml") << "x";
    std::ofstream(folder / kExposureLog) << "x";
  }
  EXPECT_FALSE(is_there(folder));
}

TEST(RigFolder, KeepsWhatOthersPutThereAndCanBeTakenAgain) {
  const fs::path folder = fresh_folder() / "rig";
  {
    const RigFolder rig = taken(folder, true);
    std::ofstream(folder / "rig.toml") << "x";
    std::ofstream(folder / kExposureLog) << "x";
    fs::create_directories(folder / "scans" / "a.weft");
  }
  EXPECT_FALSE(is_there(folder / "rig.toml"));
  EXPECT_TRUE(is_there(folder / kExposureLog)) << "it was asked to keep it";
  EXPECT_TRUE(is_there(folder / "scans" / "a.weft"));
  EXPECT_TRUE(RigFolder::take(folder, false));
}

TEST(RigFolder, ClearsWhatAKilledRigLeft) {
  const fs::path folder = fresh_folder() / "rig";
  fs::create_directories(folder / "calibration");
  std::ofstream(folder / "lock");
  fs::create_symlink("/dev/null", folder / "board");
  const RigFolder rig = taken(folder);
  EXPECT_FALSE(fs::exists(fs::symlink_status(folder / "board")));
  EXPECT_FALSE(is_there(folder / "calibration"));
}

TEST(RigFolder, LeavesAFolderAloneThatNoRigMade) {
  const fs::path folder = fresh_folder();
  std::ofstream(folder / "thesis.txt") << "x";
  const Result<RigFolder> rig = RigFolder::take(folder, false);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().kind, ErrorKind::kCannotCreate);
  EXPECT_TRUE(is_there(folder / "thesis.txt"));
}

}  // namespace
}  // namespace weft::virtual_rig
