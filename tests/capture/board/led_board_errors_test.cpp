// SPDX-License-Identifier: Apache-2.0
// Ports that cannot be opened and boards that cannot be used: what a person is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <functional>

#include "capture/board/led_board.h"
#include "core/base/descriptor.h"
#include "tests/capture/board/desk.h"
#include "virtual_rig/terminal/modem_lines.h"

namespace weft::capture {
namespace {

using test::Desk;
using test::LightHolder;
using testing::HasSubstr;

Error error_of(const LedBoardOptions& options) {
  const auto board = LedBoard::open(options);
  return board ? Error{} : board.error();
}

TEST(OpeningALedBoard, SaysThatItIsNotThere) {
  const Error error = error_of({"/dev/weft-no-such-board"});
  EXPECT_EQ(error.kind, ErrorKind::kNoDevice);
  EXPECT_THAT(error.message(), HasSubstr("/dev/weft-no-such-board: No such file"));
  EXPECT_THAT(error.remedy, HasSubstr("ls /dev/serial/by-id"));
}

TEST(OpeningALedBoard, RefusesAFileThatIsNoSerialPort) {
  const std::string file = testing::TempDir() + "no_port_" + std::to_string(getpid());
  std::ofstream(file) << "text";
  const Error error = error_of({file});
  std::filesystem::remove(file);
  EXPECT_EQ(error.kind, ErrorKind::kNoDevice);
  EXPECT_THAT(error.message(), HasSubstr("not a serial port"));
}

TEST(OpeningALedBoard, IsRefusedASecondTimeInOneProcess) {
  Desk desk;
  const auto board = desk.open();
  const Error error = error_of(desk.options());
  EXPECT_EQ(error.kind, ErrorKind::kNoDevice) << error.message();
  EXPECT_THAT(error.message(), HasSubstr("held by another program"));
  const auto status = board->status();
  EXPECT_TRUE(status) << "the one that has it was disturbed: " << status.error().message();
}

TEST(OpeningALedBoard, SaysWhichProcessHoldsIt) {
  Desk desk;
  LightHolder host(desk.port(), 3);
  ASSERT_TRUE(desk.comes_to_light({3}, 10));
  const Error error = error_of(desk.options());
  EXPECT_EQ(error.kind, ErrorKind::kNoDevice);
  EXPECT_THAT(error.message(), HasSubstr("hold_light (process " + std::to_string(host.process()) + ")"));
  EXPECT_EQ(desk.pins().now(), 4) << "asking for the port disturbed the light";
}

TEST(OpeningALedBoard, KeepsOtherProgramsOut) {
  Desk desk;
  const auto lines = virtual_rig::open_modem_lines(desk.folder() / "modem");
  ASSERT_TRUE(lines);
  EXPECT_EQ(lines->exclusive.load(), 0U);
  const auto board = desk.open();
  EXPECT_EQ(lines->exclusive.load(), 1U) << "TIOCEXCL";
}

TEST(OpeningALedBoard, IsFreeAgainWhenItIsClosed) {
  Desk desk;
  for (int i = 0; i < 3; ++i) EXPECT_NO_THROW(desk.open()) << i;
}

/// Whether it holds in a child that is nobody: root may open anything.
bool holds_for_nobody(const std::function<bool()>& condition) {
  const pid_t child = fork();
  if (child == 0) _exit(setuid(65534) == 0 && condition() ? 0 : 1);
  int state = 0;
  waitpid(child, &state, 0);
  return WIFEXITED(state) && WEXITSTATUS(state) == 0;
}

TEST(OpeningALedBoard, SaysHowToBeAllowedToByTheGroupThatOwnsThePort) {
  if (geteuid() != 0) GTEST_SKIP() << "needs root to become somebody else";
  struct Ownership {
    gid_t group;
    mode_t mode;
    const char* remedy;
  };
  for (const auto& [group, mode, remedy] :
       {Ownership{20, 0660, "usermod -aG dialout $USER"}, Ownership{5, 0660, "usermod -aG tty $USER"},
        Ownership{0, 0600, "no group may open it"}, Ownership{20, 0600, "sudo chmod a+rw"}}) {
    Desk desk;
    const std::string terminal = std::filesystem::read_symlink(desk.terminal());
    ASSERT_EQ(chown(terminal.c_str(), 0, group), 0);
    ASSERT_EQ(chmod(terminal.c_str(), mode), 0);
    EXPECT_TRUE(holds_for_nobody([&, remedy = remedy] {
      const Error error = error_of({terminal});
      return error.kind == ErrorKind::kNoDevice && error.remedy.find(remedy) != std::string::npos;
    })) << remedy;
  }
}

TEST(OpeningALedBoard, SaysWhoHasItForItselfAlone) {
  if (geteuid() != 0) GTEST_SKIP() << "needs root to become somebody else";
  Desk desk;
  LightHolder host(desk.port(), 3);
  ASSERT_TRUE(desk.comes_to_light({3}, 10));
  const std::string terminal = std::filesystem::read_symlink(desk.terminal());
  ASSERT_EQ(chmod(terminal.c_str(), 0666), 0);
  const Descriptor exclusive(terminal, O_RDWR | O_NOCTTY);
  ASSERT_EQ(syscall(SYS_ioctl, exclusive.get(), TIOCEXCL), 0) << "past the shim, which keeps it to itself";
  EXPECT_TRUE(holds_for_nobody([&] {
    const std::string said = error_of({terminal}).message();
    return said.find("hold_light (process " + std::to_string(host.process()) + ")") != std::string::npos;
  }));
}

TEST(OpeningALedBoard, RefusesAnOlderAndANewerFirmware) {
  for (const std::string version : {"older", "newer"}) {
    Desk desk("firmware_" + version);
    const Error error = error_of(desk.options());
    EXPECT_EQ(error.kind, ErrorKind::kBadData) << error.message();
    EXPECT_THAT(error.message(), HasSubstr(version == "older" ? "too old" : "newer than this weft"));
    EXPECT_THAT(error.remedy, HasSubstr("weft rig flash"));
  }
}

TEST(OpeningALedBoard, GivesUpOnABoardThatIsSilent) {
  Desk desk;
  desk.inject(virtual_rig::VirtualBoardFault::kDeaf);
  const Error error = error_of({desk.port(), 0.5});
  EXPECT_EQ(error.kind, ErrorKind::kTryAgain) << error.message();
  EXPECT_THAT(error.message(), HasSubstr("does not answer: " + desk.port() +
                                         ": the port was silent for 0.5 s; its "
                                         "USB identity is not known"));
  EXPECT_THAT(error.message(), testing::Not(HasSubstr("flash")));
}

TEST(OpeningALedBoard, AdvisesFlashingWhereASilentPortIsAnUno) {
  Desk desk = Desk::with_usb();
  desk.inject(virtual_rig::VirtualBoardFault::kDeaf);
  const Error error = error_of({"/dev/ttyACM0", 0.5});
  EXPECT_THAT(error.message(), HasSubstr("it is \"Arduino Uno\", USB 2341:0043"));
  EXPECT_THAT(error.remedy, HasSubstr("flash its firmware: weft rig flash /dev/ttyACM0"));
}

}  // namespace
}  // namespace weft::capture
