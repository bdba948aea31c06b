// SPDX-License-Identifier: Apache-2.0
// weft doctor of virtual rigs that nothing is wrong with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "capture/rig.h"
#include "core/base/json_document.h"
#include "tests/core/places.h"
#include "tests/virtual_rig/ptp/client_process.h"
#include "tests/virtual_rig/small_scene.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using virtual_rig::ProgramRun;

class DoctorProgram : public testing::Test {
 protected:
  DoctorProgram() : folder_(virtual_rig::fresh_folder()) {
    std::ofstream(folder_ / "scene.toml") << to_toml(virtual_rig::small_scene());
  }
  ~DoctorProgram() override { rig({"--folder", "rig", "--inject", "end"}); }

  ProgramRun rig(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), program_path("weft-virtual-rig"));
    return virtual_rig::run_program(arguments, {"XDG_CACHE_HOME=" + (folder_ / "cache").string()},
                                    folder_.string(), 60);
  }
  /// weft as a person uses it of the rig in the background.
  ProgramRun weft(const std::string& words) const {
    return virtual_rig::run_program(
        {"/bin/sh", "-c",
         "exec env $(cat rig/environment) " + std::string(program_path("weft")) + " " + words},
        {}, folder_.string(), 60);
  }
  ProgramRun doctor() const { return weft("doctor"); }

  const fs::path folder_;
};

TEST_F(DoctorProgram, GreetsTheDevicesOfARigInTheBackground) {
  ASSERT_EQ(rig({"scene.toml", "--folder", "rig", "--no-wait"}).exit_code, 0);
  const ProgramRun ran = doctor();
  EXPECT_EQ(ran.exit_code, 0) << ran.output;
  EXPECT_THAT(ran.output,
              AllOf(HasSubstr("firmware "), HasSubstr("D5100 6000001"), Not(HasSubstr(" holds "))));
}

TEST_F(DoctorProgram, FindsTheCameraOfARigOnUsbAndTellsWhenItIsGone) {
  ASSERT_EQ(rig({"scene.toml", "--folder", "rig", "--no-wait", "--usb"}).exit_code, 0);
  const ProgramRun there = doctor();
  EXPECT_EQ(there.exit_code, 0) << there.output;
  EXPECT_THAT(there.output, AllOf(HasSubstr("D5100 6000001 at usb:"), Not(HasSubstr("fault"))));
  ASSERT_EQ(rig({"--folder", "rig", "--inject", "camera usb_unplug_now"}).exit_code, 0);
  const ProgramRun gone = doctor();
  EXPECT_EQ(gone.exit_code, 69) << gone.output;
  EXPECT_THAT(gone.output, AllOf(HasSubstr("fault    camera       no D5100 on USB"), HasSubstr("firmware ")));
}

TEST_F(DoctorProgram, LooksAtTheMachineWithoutARigFileToo) {
  const ProgramRun ran =
      virtual_rig::run_program({program_path("weft"), "doctor"},
                               {"HOME=" + folder_.string(), "XDG_CONFIG_HOME="}, folder_.string(), 60);
  EXPECT_NE(ran.exit_code, 0);
  EXPECT_THAT(ran.output,
              AllOf(HasSubstr("fault    rig file"), HasSubstr("weft rig new"), HasSubstr("board")));
}

TEST_F(DoctorProgram, FindsNothingWrongWithARigFileThatRigNewWrote) {
  ASSERT_EQ(rig({"scene.toml", "--folder", "rig", "--no-wait"}).exit_code, 0);
  const Result<Rig> played = read_rig(folder_ / "rig" / "rig.toml");
  ASSERT_TRUE(played) << played.error().message();
  const std::string make =
      "rig new north -o new.toml --board " + played->board.port + " --camera " + played->camera.port;
  const ProgramRun made = weft(make);
  EXPECT_EQ(made.exit_code, 0) << made.output;
  EXPECT_THAT(made.output, AllOf(HasSubstr("board at "), HasSubstr("camera D5100 6000001")));
  const Result<Rig> read = read_rig(folder_ / "new.toml");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->name, "north");
  EXPECT_EQ(read->leds, 10);
  EXPECT_EQ(read->board.port, played->board.port);
  EXPECT_EQ(read->camera.serial, "6000001");
  const ProgramRun examined = weft("doctor --rig new.toml");
  EXPECT_EQ(examined.exit_code, 0) << examined.output;
  EXPECT_THAT(weft(make).output, HasSubstr("there is such a file")) << "nothing is lost";
  const ProgramRun rubbish = weft("rig new $(printf 'a\\377') -o rubbish.toml");
  EXPECT_EQ(rubbish.exit_code, 64) << rubbish.output;
  EXPECT_FALSE(fs::exists(folder_ / "rubbish.toml"));
}

TEST_F(DoctorProgram, NamesTheOtherDeviceAtThePortByWhatItSays) {
  const std::vector<std::pair<std::string, std::string>> kinds = {
      {"gps", "a GPS receiver sends of its own accord: \"$GPGGA"},
      {"printer", "a 3D printer sends of its own accord: "},
      {"modem", "a modem answers: \"ERROR\""},
      {"echo", "a device that echoes, or a cable's loop, answers: what it was sent"},
      {"silent", "the port was silent for"}};
  for (const auto& [kind, says] : kinds) {
    SCOPED_TRACE(kind);
    ASSERT_EQ(rig({"scene.toml", "--folder", "rig", "--no-wait", "--beside", kind}).exit_code, 0);
    const ProgramRun board = weft("rig status");
    EXPECT_EQ(board.exit_code, 0) << board.output;
    EXPECT_THAT(board.output, AllOf(HasSubstr("firmware "), HasSubstr("D5100 6000001")));
    ASSERT_EQ(virtual_rig::run_program(
                  {"/bin/sh", "-c", "sed s:/rig/board:/rig/beside: rig/rig.toml >rig/other.toml"}, {},
                  folder_.string(), 10)
                  .exit_code,
              0);
    const ProgramRun other = weft("rig status --rig rig/other.toml");
    EXPECT_EQ(other.exit_code, kind == "silent" ? 75 : 65) << other.output;
    EXPECT_THAT(other.output, AllOf(HasSubstr(says), HasSubstr("/rig/beside"), Not(HasSubstr("flash"))));
    if (kind == "gps") {
      const ProgramRun scan = weft("scan --fabric satin --rig rig/other.toml");
      EXPECT_EQ(scan.exit_code, 65);
      EXPECT_THAT(scan.output, HasSubstr(says));
    }
    EXPECT_EQ(rig({"--folder", "rig", "--inject", "end"}).exit_code, 0);
  }
}

TEST_F(DoctorProgram, NamesABoardOfOlderFirmwareAndHowToFlashIt) {
  const auto status_with = [&](const std::string& firmware) {
    EXPECT_EQ(rig({"scene.toml", "--folder", "rig", "--no-wait", "--firmware",
                   WEFT_FIRMWARE_VERSIONS "/" + firmware + ".elf"})
                  .exit_code,
              0);
    ProgramRun ran = weft("rig status");
    EXPECT_EQ(rig({"--folder", "rig", "--inject", "end"}).exit_code, 0);
    return ran;
  };
  const ProgramRun before = status_with("firmware_before");
  EXPECT_EQ(before.exit_code, 0) << before.output;
  EXPECT_THAT(before.output, AllOf(HasSubstr("it speaks protocol 1.0, this weft 1.1"),
                                   HasSubstr("weft rig flash /dev/"), HasSubstr("/rig/board")));
  const ProgramRun older = status_with("firmware_older");
  EXPECT_EQ(older.exit_code, 65) << older.output;
  EXPECT_THAT(older.output,
              AllOf(HasSubstr("the LED board's firmware is too old"),
                    HasSubstr("it speaks protocol 0.1, this weft 1.1"), HasSubstr("weft rig flash /dev/")));
}

}  // namespace
}  // namespace weft::capture
