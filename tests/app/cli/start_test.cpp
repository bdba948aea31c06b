// SPDX-License-Identifier: Apache-2.0
// What programs load before they do anything.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tests/core/places.h"

namespace weft::app {
namespace {

using testing::HasSubstr;

struct Said {
  std::string text;
  int status = -1;  ///< as the shell says it
};

Said said_by(const std::string& command) {
  Said said;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> block = {};
  for (std::size_t n; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;)
    said.text.append(block.data(), n);
  const int status = ::pclose(pipe);
  said.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return said;
}

/// Names of the shared objects that the loader maps for a program, those of its libraries too.
std::vector<std::string> loaded_by(const std::string& program) {
  std::vector<std::string> names;
  std::istringstream lines(said_by("LD_TRACE_LOADED_OBJECTS=1 '" + program + "'").text);
  for (std::string name, rest; lines >> name && std::getline(lines, rest);) names.push_back(name);
  return names;
}

bool loads(const std::vector<std::string>& names, const std::string& begin) {
  return std::ranges::any_of(names, [&](const std::string& name) { return name.starts_with(begin); });
}

TEST(Start, LoadsNeitherOpenCVNorReadersOfImages) {
  const std::vector<std::string> light = loaded_by(program_path("weft"));
  EXPECT_TRUE(loads(light, "libc.so")) << testing::PrintToString(light);
  for (const char* heavy :
       {"libopencv", "libembree", "libceres", "libglog", "libOpenEXR", "libtiff", "libpng"})
    EXPECT_FALSE(loads(light, heavy)) << heavy << " among " << testing::PrintToString(light);
  EXPECT_LT(light.size(), 40U) << testing::PrintToString(light);
  // The same question finds them where they are.
  const std::vector<std::string> heavy = loaded_by(program_path("weft-work"));
  EXPECT_TRUE(loads(heavy, "libtiff")) << testing::PrintToString(heavy);
  EXPECT_TRUE(loads(heavy, "libopencv")) << testing::PrintToString(heavy);
}

// They bring in more than a hundred libraries each, for formats that weft does not read.
TEST(Start, NoProgramLoadsOpenImageIOOrOpenCVsCodecs) {
  for (const char* program : {"weft-work", "weft-bench", "weft-virtual-rig"}) {
    const std::vector<std::string> whole = loaded_by(program_path(program));
    EXPECT_TRUE(loads(whole, "libc.so")) << program;
    for (const char* many : {"libOpenImageIO", "libopencv_imgcodecs", "libgdal", "libavcodec"})
      EXPECT_FALSE(loads(whole, many))
          << program << ": " << many << " among " << testing::PrintToString(whole);
  }
}

TEST(Start, HelpIsThatOfTheProgramWithAllVerbs) {
  const Said light = said_by(program_path("weft") + " --help"),
             whole = said_by(program_path("weft-work") + " --help");
  EXPECT_EQ(light.status, 0);
  EXPECT_EQ(light.text, whole.text);
  EXPECT_THAT(light.text, HasSubstr("solve"));
}

TEST(Start, AVerbThatIsElsewhereKeepsItsWordsAndItsExitCode) {
  for (const char* words : {"solve --help", "solve no-such.weft", "calibrate camera --no-such"}) {
    const Said light = said_by(program_path("weft") + " " + words);
    const Said whole = said_by(program_path("weft-work") + " " + words);
    EXPECT_EQ(light.status, whole.status) << words << "\n" << light.text;
    EXPECT_EQ(light.text, whole.text) << words;
  }
}

TEST(Start, AWordThatIsNoVerbIsRefusedAtOnce) {
  EXPECT_EQ(said_by(program_path("weft") + " solv").status, 64);
  EXPECT_EQ(said_by(program_path("weft")).status, 64);
}

TEST(Start, VersionNamesTheCommit) {
  const Said said = said_by(program_path("weft") + " --version");
  EXPECT_EQ(said.status, 0);
  const Said commit = said_by("git -C '" + source_folder().string() + "' cat-file -e HEAD");
  EXPECT_THAT(said.text,
              testing::ContainsRegex(commit.status == 0 ? "^" WEFT_VERSION " \\([0-9a-f]{12}(-dirty)?\\)\n$"
                                                        : "^" WEFT_VERSION "\n$"));
}

}  // namespace
}  // namespace weft::app
