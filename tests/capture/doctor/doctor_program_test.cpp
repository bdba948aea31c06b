// SPDX-License-Identifier: Apache-2.0
// weft doctor of virtual rigs that nothing is wrong with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
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
  /// weft doctor as a person asks it of the rig in the background.
  ProgramRun doctor() const {
    return virtual_rig::run_program(
        {"/bin/sh", "-c", std::string("exec env $(cat rig/environment) ") + program_path("weft") + " doctor"},
        {}, folder_.string(), 60);
  }

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
  const auto weft = [&](const std::string& words) {
    return virtual_rig::run_program(
        {"/bin/sh", "-c", "exec env $(cat rig/environment) " + std::string(program_path("weft")) + words}, {},
        folder_.string(), 60);
  };
  const std::string make =
      " rig new north -o new.toml --board " + played->board.port + " --camera " + played->camera.port;
  const ProgramRun made = weft(make);
  EXPECT_EQ(made.exit_code, 0) << made.output;
  EXPECT_THAT(made.output, AllOf(HasSubstr("board at "), HasSubstr("camera D5100 6000001")));
  const Result<Rig> read = read_rig(folder_ / "new.toml");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->name, "north");
  EXPECT_EQ(read->leds, 10);
  EXPECT_EQ(read->board.port, played->board.port);
  EXPECT_EQ(read->camera.serial, "6000001");
  const ProgramRun examined = weft(" doctor --rig new.toml");
  EXPECT_EQ(examined.exit_code, 0) << examined.output;
  EXPECT_THAT(weft(make).output, HasSubstr("there is such a file")) << "nothing is lost";
  const ProgramRun rubbish = weft(" rig new $(printf 'a\\377') -o rubbish.toml");
  EXPECT_EQ(rubbish.exit_code, 64) << rubbish.output;
  EXPECT_FALSE(fs::exists(folder_ / "rubbish.toml"));
}

}  // namespace
}  // namespace weft::capture
