// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/camera_profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "core/base/files.h"

namespace weft::capture {
namespace {

std::string saved(const std::string& toml) {
  const std::string file = testing::TempDir() + "weft_camera_profile_" + std::to_string(getpid()) + ".toml";
  EXPECT_TRUE(write_file(file, toml));
  return file;
}

Result<CameraProfile> read(const std::string& toml) {
  const std::string file = saved(toml);
  Result<CameraProfile> profile = read_camera_profile(file);
  std::filesystem::remove(file);
  return profile;
}

const char kLeast[] = R"(
model = "Z 6"
[widgets]
shutter = "shutterspeed2"
iso = "iso"
)";

TEST(CameraProfile, OfTheD5100IsBuiltIn) {
  const auto profile = read_camera_profile("nikon-d5100");
  ASSERT_TRUE(profile) << profile.error().message();
  EXPECT_EQ(profile->model, "D5100");
  EXPECT_THAT(profile->usb_models, testing::ElementsAre("Nikon DSC D5100 (PTP mode)"));
  EXPECT_EQ(profile->trigger, CameraProfile::Trigger::kBlocks);
  EXPECT_EQ(profile->widgets.shutter, "shutterspeed2");
  EXPECT_EQ(profile->by_hand.size(), 2U);
  EXPECT_THAT(profile->set, testing::Contains(testing::Pair("imagequality", "NEF (Raw)")));
}

TEST(CameraProfile, OfTheD5100CanBeWrittenOutAndRead) {
  const auto profile = read(std::string(nikon_d5100_toml()));
  ASSERT_TRUE(profile) << profile.error().message();
  EXPECT_EQ(profile->set, read_camera_profile("nikon-d5100")->set);
}

TEST(CameraProfile, NeedsLittle) {
  const auto profile = read(kLeast);
  ASSERT_TRUE(profile) << profile.error().message();
  EXPECT_EQ(profile->ptpip_model, "PTP/IP Camera");
  EXPECT_EQ(profile->trigger, CameraProfile::Trigger::kReturnsAtOnce) << "right for either kind of body";
  EXPECT_TRUE(profile->widgets.f_number.empty());
  EXPECT_TRUE(profile->by_hand.empty());
}

TEST(CameraProfile, SaysWhichKeyIsWrong) {
  const std::string least = kLeast;
  for (const auto& [toml, key] : std::vector<std::pair<std::string, std::string>>{
           {"model = \"Z 6\"\n[widgets]\niso = \"iso\"\n", "shutter"},
           {"modle = \"Z 6\"\n" + least, "modle"},
           {"readout_s = -1\n" + least, "readout_s"},
           {"trigger = \"sometimes\"\n" + least, "trigger"},
           {least + "[set]\nimagequality = 4\n", "set.imagequality"},
           {least + "[[by_hand]]\nwidget = \"expprogram\"\nsays = \"a\"\nremedy = \"b\"\n", "values"}}) {
    const auto profile = read(toml);
    ASSERT_FALSE(profile) << toml;
    EXPECT_EQ(profile.error().kind, ErrorKind::kBadData) << profile.error().message();
    EXPECT_THAT(profile.error().message(), testing::HasSubstr(key));
  }
}

TEST(CameraProfile, ThatIsNotThereIsNamed) {
  const auto unknown = read_camera_profile("nikon-d5200");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(unknown.error().message(), testing::HasSubstr("nikon-d5100"));
  const auto absent = read_camera_profile("/nowhere/body.toml");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().kind, ErrorKind::kNoInput);
}

}  // namespace
}  // namespace weft::capture
