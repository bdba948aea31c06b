// SPDX-License-Identifier: Apache-2.0
// weft rig flash onto a virtual board; a program that only says how it was called stands in for avrdude.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/capture/board/desk.h"
#include "tests/core/places.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;
using test::Desk;
using testing::AllOf;
using testing::HasSubstr;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The exit code of weft rig flash; what it said is in the desk's folder.
int flash(const Desk& desk, const std::string& port, const std::string& avrdude) {
  const fs::path programs = desk.folder() / "programs";
  fs::create_directories(programs);
  if (!avrdude.empty()) {
    std::ofstream(programs / "avrdude") << "#!/bin/sh\n" << avrdude << "\n";
    fs::permissions(programs / "avrdude", fs::perms::owner_all);
  }
  const std::string command = "cd '" + desk.folder().string() +
                              "' && PATH=\"$PWD/programs:/usr/bin:/bin\" LD_PRELOAD='" + WEFT_TERMINAL_SHIM +
                              "' '" + WEFT_PROGRAM + "' rig flash " + port + " >said 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
std::string said(const Desk& desk) {
  return text_of(desk.folder() / "said");
}

TEST(RigFlash, WritesTheCarriedFirmwareAsThePageSaysAndAsksTheBoard) {
  const Desk desk = Desk::with_usb();
  EXPECT_EQ(flash(desk, "/dev/ttyACM0",
                  "echo avrdude \"$@\" >calls; "
                  "f=${11#flash:w:}; cp \"${f%:i}\" written"),
            0)
      << said(desk);
  const std::string page = text_of(in_sources("docs/rig.md"));
  const std::size_t begin = page.find("avrdude -c");
  ASSERT_NE(begin, std::string::npos);
  const std::string line = page.substr(begin, page.find("firmware.hex", begin) - begin);
  EXPECT_THAT(text_of(desk.folder() / "calls"), HasSubstr(line.substr(0, line.find("flash:w:") + 8)));
  std::string built = text_of(fs::path(WEFT_FIRMWARE) / "firmware.hex");
  std::erase(built, '\r');
  EXPECT_TRUE(text_of(desk.folder() / "written") == built) << "other bytes than those that were built";
  EXPECT_THAT(said(desk), AllOf(HasSubstr("board   /dev/ttyACM0"), HasSubstr("10 LEDs")));
}

TEST(RigFlash, SaysHowToGetAvrdudeAndThatItFailed) {
  const Desk desk = Desk::with_usb();
  EXPECT_EQ(flash(desk, "/dev/ttyACM0", "echo no sync >&2; exit 1"), 76);
  EXPECT_THAT(said(desk),
              AllOf(HasSubstr("no sync"), HasSubstr("the board was not flashed: /dev/ttyACM0: avrdude "
                                                    "ended with exit code 1")));
  fs::remove(desk.folder() / "programs/avrdude");
  if (fs::exists("/usr/bin/avrdude")) GTEST_SKIP() << "avrdude is installed";
  EXPECT_EQ(flash(desk, "/dev/ttyACM0", ""), 66);
  EXPECT_THAT(said(desk), HasSubstr("sudo apt-get install avrdude"));
}

TEST(RigFlash, RefusesAPortThatIsNoUnoUnlessItIsMeant) {
  const Desk desk;
  EXPECT_EQ(flash(desk, desk.port(), "touch called"), 65);
  EXPECT_THAT(said(desk), HasSubstr("no Arduino Uno or Nano by its USB identity"));
  EXPECT_FALSE(fs::exists(desk.folder() / "called"));
  EXPECT_EQ(flash(desk, desk.port() + " --any-board", "touch called"), 0) << said(desk);
  EXPECT_TRUE(fs::exists(desk.folder() / "called"));
  EXPECT_EQ(flash(desk, "/dev/no-board", "touch called"), 69);
}

}  // namespace
}  // namespace weft::capture
