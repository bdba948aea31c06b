// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/logbook.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/app/server/scripted_rig.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class LogbookFolder : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  const fs::path folder_ = fs::path(testing::TempDir()) / ("weft_logbook_" + std::to_string(getpid()));
};

TEST_F(LogbookFolder, WritesAJsonLineAndSaysALineAnEvent) {
  std::vector<std::string> said;
  Logbook log(folder_ / "log", [&](const std::string& line) { said.push_back(line); });
  log.add("scan_began", "a {} of \"satin\"", {{"session", "a"}});
  log.add("fault", "the camera hangs");
  const std::vector<Json> lines = json_lines(folder_ / "log" / "weft.jsonl");  // while it is open
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0]["event"], "scan_began");
  EXPECT_EQ(lines[0]["says"], "a {} of \"satin\"");
  EXPECT_EQ(lines[0]["session"], "a");
  EXPECT_THAT(lines[0]["time"].get<std::string>(), testing::EndsWith("Z"));
  EXPECT_THAT(said, testing::ElementsAre("scan_began: a {} of \"satin\"", "fault: the camera hangs"));
}

TEST_F(LogbookFolder, IsGoneOnWithAndKeepsFiveFilesOfFourMegabytes) {
  { Logbook(folder_, {}).add("first", ""); }
  Logbook log(folder_, {});
  log.add("second", "");
  EXPECT_EQ(json_lines(folder_ / "weft.jsonl").size(), 2U);
  const std::string much(100'000, 'x');
  for (int i = 0; i < 300; ++i) log.add("much", much);
  std::uintmax_t bytes = 0;
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    bytes += entry.file_size();
    ++files;
  }
  EXPECT_EQ(files, 5);
  EXPECT_LE(bytes, 5U << 22);
}

TEST_F(LogbookFolder, ThatCannotBeWrittenKeepsNobodyFromScanning) {
  std::ofstream(folder_ / "file") << "no folder";
  std::vector<std::string> said;
  Logbook log(folder_ / "file" / "log", [&](const std::string& line) { said.push_back(line); });
  log.add("fault", "the camera hangs");
  ASSERT_EQ(said.size(), 2U);
  EXPECT_THAT(said[0], HasSubstr("no log: "));
  EXPECT_EQ(said[1], "fault: the camera hangs");
}

}  // namespace
}  // namespace weft::app
