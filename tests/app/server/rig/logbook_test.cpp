// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/logbook.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
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

TEST_F(LogbookFolder, IsReadByPagesOfNumberedLines) {
  const auto numbers = [&](std::optional<std::int64_t> after, std::size_t limit) {
    std::vector<int> found;
    for (const Json& line : read_log(folder_, after, limit).lines) found.push_back(line["number"].get<int>());
    return found;
  };
  EXPECT_THAT(numbers({}, 10), testing::IsEmpty());
  for (int run = 0; run < 2; ++run) {
    Logbook log(folder_, {});
    for (int i = 0; i < 3; ++i) log.add("step", "");
  }
  std::ofstream(folder_ / "weft.jsonl", std::ios::app) << "half a li";
  EXPECT_THAT(numbers({}, 10), testing::ElementsAre(1, 2, 3, 4, 5, 6)) << "numbers go on after a restart";
  EXPECT_THAT(numbers({}, 2), testing::ElementsAre(5, 6)) << "the newest";
  EXPECT_THAT(numbers(0, 2), testing::ElementsAre(1, 2));
  EXPECT_THAT(numbers(4, 2), testing::ElementsAre(5, 6));
  EXPECT_TRUE(read_log(folder_, 3, 2).more);
  EXPECT_FALSE(read_log(folder_, 4, 2).more);
  EXPECT_THAT(numbers(6, 2), testing::IsEmpty());

  Logbook log(folder_, {});
  log.add("step", "");
  for (int i = 0; i < 60; ++i) log.add("much", std::string(100'000, 'x'));
  ASSERT_TRUE(fs::exists(folder_ / "weft.1.jsonl"));
  EXPECT_EQ(numbers(1, 1000).front(), 2) << "of a file before";
  EXPECT_EQ(numbers({}, 1).front(), 67);
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
