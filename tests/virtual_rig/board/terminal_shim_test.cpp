// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "tests/capture/board/desk.h"
#include "virtual_rig/board/virtual_board.h"
#include "virtual_rig/terminal/modem_lines.h"
#include "virtual_rig/terminal/port_name.h"

namespace weft::virtual_rig {
namespace {

class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& path)
      : file_(open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)) {}
  ~OpenFile() { close(file_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  operator int() const { return file_; }  // NOLINT(google-explicit-constructor)

 private:
  int file_;
};

std::uint32_t rises_of(const test::Desk& desk) {
  return open_modem_lines(desk.terminal().parent_path() / "modem")->dtr_rises;
}

TEST(TerminalShim, GivesTheBoardsTerminalModemLines) {
  test::Desk desk;
  const OpenFile terminal(desk.terminal());
  int lines = 0;
  ASSERT_EQ(ioctl(terminal, TIOCMGET, &lines), 0);
  EXPECT_EQ(lines & (TIOCM_DTR | TIOCM_CTS), TIOCM_CTS);
  lines = TIOCM_DTR | TIOCM_RTS;
  ASSERT_EQ(ioctl(terminal, TIOCMSET, &lines), 0);
  ASSERT_EQ(ioctl(terminal, TIOCMGET, &lines), 0);
  EXPECT_EQ(lines & (TIOCM_DTR | TIOCM_RTS), TIOCM_DTR | TIOCM_RTS);
}

TEST(TerminalShim, CountsEveryRiseOfDtrAndNothingElse) {
  test::Desk desk;
  const OpenFile terminal(desk.terminal());
  const std::uint32_t before = rises_of(desk);
  int dtr = TIOCM_DTR;
  for (int i = 0; i < 3; ++i) {
    ioctl(terminal, TIOCMBIS, &dtr);
    ioctl(terminal, TIOCMBIS, &dtr);
    ioctl(terminal, TIOCMBIC, &dtr);
  }
  EXPECT_EQ(rises_of(desk) - before, 3U);
}

TEST(TerminalShim, LeavesEveryOtherTerminalAlone) {
  test::Desk desk;
  const auto other_link = desk.terminal().parent_path() / "other";
  const auto other = PseudoTerminal::make(other_link);
  ASSERT_TRUE(other) << other.error().message();
  const OpenFile terminal(other_link);
  int lines = 0;
  errno = 0;
  EXPECT_EQ(ioctl(terminal, TIOCMGET, &lines), -1);
  EXPECT_EQ(errno, ENOTTY);
  const OpenFile no_terminal("/dev/null");
  EXPECT_EQ(ioctl(no_terminal, TIOCMGET, &lines), -1);
}

TEST(TerminalShim, DoesNothingWithoutItsVariable) {
  test::Desk desk;
  const OpenFile terminal(desk.terminal());
  unsetenv(kModemVariable);
  int lines = 0;
  EXPECT_EQ(ioctl(terminal, TIOCMGET, &lines), -1);
}

TEST(TerminalPortName, NamesTheSameFileFromBelowDevAndBelowSys) {
  test::Desk desk;
  const std::string name = terminal_port_name(desk.terminal());
  ASSERT_TRUE(name.starts_with("/dev/"));
  struct stat by_name {
  }, by_path{}, by_class{};
  ASSERT_EQ(stat(name.c_str(), &by_name), 0);
  ASSERT_EQ(stat(("/sys/class/tty/" + name.substr(5)).c_str(), &by_class), 0);
  ASSERT_EQ(stat(desk.terminal().c_str(), &by_path), 0);
  EXPECT_EQ(by_name.st_rdev, by_path.st_rdev);
  EXPECT_EQ(by_class.st_rdev, by_path.st_rdev);
}

}  // namespace
}  // namespace weft::virtual_rig
