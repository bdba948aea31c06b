// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/session_name.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <ctime>
#include <string>

namespace weft::library {
namespace {

namespace fs = std::filesystem;

class SessionName : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(sessions_); }
  void TearDown() override { fs::remove_all(sessions_); }
  std::string next(const std::string& name_template, const std::string& fabric = "satin") const {
    std::tm parts = {};
    parts.tm_year = 126, parts.tm_mon = 10, parts.tm_mday = 21, parts.tm_hour = 14, parts.tm_min = 25,
    parts.tm_sec = 1;
    parts.tm_isdst = -1;
    const auto now = std::chrono::system_clock::from_time_t(std::mktime(&parts));
    const Result<std::string> name = next_session_name(name_template, fabric, "north", sessions_, now);
    return name ? *name : "error: " + name.error().message();
  }
  const fs::path sessions_ = fs::path(testing::TempDir()) / ("weft_names_" + std::to_string(getpid()));
};

TEST_F(SessionName, FollowsItsTemplate) {
  EXPECT_EQ(next("{date}_{time}_{fabric}_{rig}_{count}"), "2026-11-21_142501_satin_north_001");
  EXPECT_EQ(next("{fabric}"), "satin");
}

TEST_F(SessionName, IsNeverThatOfASessionThatIsThere) {
  fs::create_directories(sessions_ / "satin_001.weft");
  fs::create_directories(sessions_ / "satin_002.weft");
  EXPECT_EQ(next("{fabric}_{count}"), "satin_003");
  fs::create_directories(sessions_ / "satin.weft");
  EXPECT_EQ(next("{fabric}"), "satin_2");
  fs::create_symlink("nowhere", sessions_ / "satin_2.weft");
  EXPECT_EQ(next("{fabric}"), "satin_3") << "a link that leads nowhere holds its name, too";
}

TEST_F(SessionName, HoldsNothingOfAFabricThatAPathWouldRead) {
  EXPECT_EQ(next("{fabric}", "../../etc/passwd"), "etc-passwd");
  EXPECT_EQ(next("{fabric}", "blue/red 50%\n"), "blue-red-50");
  EXPECT_EQ(next("{fabric}", std::string(300, 'a')), std::string(40, 'a'));
}

TEST_F(SessionName, KeepsLettersOfEveryScript) {
  EXPECT_EQ(next("x_{fabric}_{count}", "Grüner Loden 🧶"), "x_Grüner-Loden_001");
  EXPECT_EQ(next("{fabric}", "綿"), "綿");
  EXPECT_EQ(next("{fabric}", "絹"), "絹");
  EXPECT_EQ(next("{fabric}_{count}", "🧶"), "cloth_001");
  const std::string cut = next("{fabric}", "綿綿綿綿綿綿綿綿綿綿綿綿綿綿");
  EXPECT_EQ(cut.size(), 39U) << "40 bytes hold 13 whole characters of three: " << cut;
}

TEST_F(SessionName, SaysWhatATemplateMayHold) {
  for (const char* bad : {"{fabrik}", "{fabric", "a/b", "", "{date} {fabric}", "{"}) {
    EXPECT_THAT(next(bad), testing::HasSubstr("session_name gives no name")) << bad;
  }
}

TEST_F(SessionName, IsOneSegmentOfAPath) {
  for (const char* good : {"a", "_a", "A-1.b_c", "0", "ä", "x_Gr--ner-Loden-----_001", "綿_001"})
    EXPECT_TRUE(is_session_name(good)) << good;
  for (const std::string& bad :
       {std::string(), std::string("."), std::string(".."), std::string("a/b"), std::string("-a"),
        std::string("a b"), std::string("a\0b", 3), std::string("a\xe2\x80\xae_b"), std::string("\xc3"),
        std::string(101, 'a')}) {
    EXPECT_FALSE(is_session_name(bad)) << bad;
    EXPECT_FALSE(session_folder(sessions_, bad)) << bad;
  }
}

TEST_F(SessionName, LeadsToNoFolderElsewhere) {
  fs::create_directory_symlink("/", sessions_ / "link.weft");
  const Result<fs::path> folder = session_folder(sessions_, "link");
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().kind, ErrorKind::kBadData);
  EXPECT_TRUE(session_folder(sessions_, "new"));
}

}  // namespace
}  // namespace weft::library
