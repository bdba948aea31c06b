// SPDX-License-Identifier: Apache-2.0
// ./dev flash up to the programs that it runs: programs that only say how they were called stand in for them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/core/places.h"

namespace weft::repository {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A copy of ./dev in a folder of its own, where every package is installed.
class DevFlash : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "cmake");
    fs::create_directories(folder_ / "programs");
    fs::copy(source_folder() / "dev", folder_);
    fs::copy(source_folder() / "cmake/packages.txt", folder_ / "cmake");
    stand_in("dpkg-query", "shift 3; printf 'installed %s\\n' \"$@\"");
    stand_in("cmake", "echo cmake \"$@\" >>calls");
    stand_in("avrdude", "echo avrdude \"$@\" >>calls; exit $AVRDUDE_EXIT_CODE");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void stand_in(const char* program, const std::string& does) const {
    const fs::path file = folder_ / "programs" / program;
    std::ofstream(file) << "#!/bin/sh\n" << does << "\n";
    fs::permissions(file, fs::perms::owner_all);
  }

  /// The exit code of ./dev flash; what it said is in said().
  int flash(const std::string& port, int avrdude_exit_code = 0) const {
    const std::string command =
        "cd '" + folder_.string() +
        "' && PATH=\"$PWD/programs:$PATH\" AVRDUDE_EXIT_CODE=" + std::to_string(avrdude_exit_code) +
        " ./dev flash " + port + " >said 2>&1";
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string said() const { return text_of(folder_ / "said"); }
  std::string calls() const { return text_of(folder_ / "calls"); }

  const fs::path folder_ = fs::path(testing::TempDir()) / "weft_dev_flash";
};

TEST_F(DevFlash, RefusesToFlashNoPortAndOneThatIsNotThere) {
  EXPECT_EQ(flash(""), 1);
  EXPECT_THAT(said(), HasSubstr("flash takes the port of the board: ./dev flash /dev/ttyACM0"));
  EXPECT_EQ(flash("/dev/no-board"), 1);
  EXPECT_THAT(said(), HasSubstr("there is no port /dev/no-board; ls /dev/serial/by-id names what is there"));
  EXPECT_EQ(flash("cmake/packages.txt"), 1) << "a file is no port";
  EXPECT_EQ(flash("/dev/null /dev/null"), 1);
  EXPECT_EQ(calls(), "");
}

TEST_F(DevFlash, BuildsTheFirmwareAndWritesItAsThePageSays) {
  EXPECT_EQ(flash("/dev/null"), 0) << said();
  const std::string page = text_of(in_sources("docs/rig.md"));
  const std::size_t begin = page.find("avrdude -c");
  ASSERT_NE(begin, std::string::npos);
  std::string line = page.substr(begin, page.find('`', begin) - begin);
  line.replace(line.find("/dev/ttyACM0"), 12, "/dev/null");
  line.replace(line.find("firmware.hex"), 12, "build/release/firmware/firmware.hex");
  EXPECT_EQ(calls(),
            "cmake --preset release\ncmake --build --preset release --target firmware\n" + line + "\n");
}

TEST_F(DevFlash, FailsWhereAvrdudeFails) {
  EXPECT_EQ(flash("/dev/null", 1), 1);
}

}  // namespace
}  // namespace weft::repository
