// SPDX-License-Identifier: Apache-2.0
// The walk of docs/archives.md, line by line.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <sstream>

#include "core/base/process.h"
#include "tests/core/places.h"
#include "tests/system/batch_test.h"
#include "tests/system/samples.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

// The lines of the block behind the mark.
std::vector<std::string> walk() {
  std::istringstream page(bytes_of(source_file("docs/archives.md")));
  std::vector<std::string> lines;
  bool is_marked = false, is_open = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("<!-- walk:")) is_marked = true;
    if (!is_marked) continue;
    if (line == "```" && is_open) break;
    if (is_open && !line.empty()) lines.push_back(line);
    if (line == "```sh") is_open = true;
  }
  return lines;
}

TEST_F(BatchTest, TheWalkOfThePageGoesLineByLine) {
  fill_archive(1);
  const std::vector<std::string> lines = walk();
  ASSERT_GT(lines.size(), 8U) << "the walk was not found";
  const fs::path programs = program_folder();
  for (const std::string& line : lines) {
    SCOPED_TRACE(line);
    const std::string command =
        fmt::format("cd {} && PATH={}:$PATH && {}", work_.path().string(), programs.string(), line);
    const auto shell = ChildProcess::start({"/bin/sh", "-c", command}, {}, work_ / "log");
    ASSERT_TRUE(shell);
    ASSERT_EQ((*shell)->wait(300), 0) << bytes_of(work_ / "log");
  }
  EXPECT_TRUE(fs::exists(work_ / "night.results" / "report" / "report.html"));
  ASSERT_THAT(solves_of(session(0)), testing::SizeIs(1)) << "the old one was freed";
  const Json facts =
      Json::parse(bytes_of(session(0) / "solve" / solves_of(session(0)).front() / "solve.json"));
  EXPECT_EQ(facts["method"], "standard");
}

}  // namespace
}  // namespace weft::test
