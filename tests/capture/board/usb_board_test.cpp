// SPDX-License-Identifier: Apache-2.0
// A board that is a USB device: the names it has, and coming back under another one. What libserialport
// reads of it below /dev and /sys stands in a folder (virtual_rig/terminal/usb_terminal.h).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "capture/board/led_board.h"
#include "tests/capture/board/desk.h"
#include "virtual_rig/terminal/usb_terminal.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;
using test::comes_true;
using test::Desk;
using testing::HasSubstr;
using virtual_rig::UsbTerminal;
using virtual_rig::VirtualBoardFault;

constexpr const char* kNode = "/dev/ttyACM0";
constexpr std::array kLed4 = {4};

std::unique_ptr<LedBoard> opened(const std::string& name) {
  auto board = LedBoard::open({name});
  EXPECT_TRUE(board) << name << ": " << board.error().message();
  return board ? std::move(*board) : nullptr;
}

void expect_lights(Desk& desk, LedBoard& board) {
  const auto lit = board.light(kLed4, 5);
  ASSERT_TRUE(lit) << lit.error().message();
  EXPECT_EQ(desk.pins().now(), 1 << 3);
}

/// Descriptors of this process that have the terminal open, or had it until it went.
long holders_of(const std::string& terminal) {
  return std::ranges::count_if(fs::directory_iterator("/proc/self/fd"), [&](const auto& entry) {
    std::error_code gone;
    const std::string file = fs::read_symlink(entry.path(), gone).string();
    return file == terminal || file == terminal + " (deleted)";
  });
}

TEST(UsbBoard, IsOpenedByEveryNameThatLeadsToIt) {
  Desk desk = Desk::with_usb();
  const fs::path to_node = desk.folder() / "to_node", to_link = desk.folder() / "to_link";
  fs::create_symlink(desk.folder() / "dev/ttyACM0", to_node);
  fs::create_symlink(to_node, to_link);
  for (const std::string& name :
       {std::string(kNode), std::string("/dev/weft-led"), to_node.string(), to_link.string(), desk.port()}) {
    const auto board = opened(name);
    ASSERT_TRUE(board) << name;
    EXPECT_EQ(board->facts().usb, "2341:0043 5573") << name;
  }
}

TEST(UsbBoard, IsAskedForByTheKernelsNameOfItsTerminal) {
  const fs::path link = testing::TempDir() + "weft_ptmx_" + std::to_string(getpid());
  fs::create_symlink("/dev/ptmx", link);
  const auto board = LedBoard::open({link});
  fs::remove(link);
  ASSERT_FALSE(board);
  EXPECT_THAT(board.error().message(), HasSubstr(link.string()));
  EXPECT_THAT(board.error().message(), testing::Not(HasSubstr("libserialport does not know it")))
      << "the kernel's own name of /dev/ptmx is one that libserialport knows";
}

TEST(UsbBoard, IsLetGoOnceItIsUnpluggedLitOrDark) {
  for (const bool lit : {false, true}) {
    Desk desk = Desk::with_usb();
    const auto board = opened(kNode);
    ASSERT_TRUE(board);
    if (lit) expect_lights(desk, *board);
    const std::string terminal = fs::read_symlink(desk.terminal());
    EXPECT_GT(holders_of(terminal), 0);
    desk.inject(VirtualBoardFault::kUnplug);
    EXPECT_TRUE(comes_true(1, [&] { return holders_of(terminal) == 0; }))
        << (lit ? "lit: " : "dark: ") << holders_of(terminal) << " descriptors keep its number in use";
  }
}

TEST(UsbBoard, IsFoundAgainUnderAnotherName) {
  Desk desk = Desk::with_usb();
  const auto board = opened(kNode);
  ASSERT_TRUE(board);
  expect_lights(desk, *board);
  for (int i = 1; i <= 3; ++i) {
    desk.inject(VirtualBoardFault::kElsewhere);
    EXPECT_TRUE(fs::is_symlink("/dev/ttyACM" + std::to_string(i)));
    const auto found = board->recover();
    ASSERT_TRUE(found) << found.error().message();
    expect_lights(desk, *board);
  }
}

TEST(UsbBoard, IsNotTakenForAnotherThatCameUnderItsName) {
  Desk desk = Desk::with_usb();
  const auto board = opened(kNode);
  ASSERT_TRUE(board);
  desk.inject(VirtualBoardFault::kElsewhere);
  const auto other = UsbTerminal::make(desk.folder(), 0, "another", "/dev/null");
  ASSERT_TRUE(other) << other.error().message();
  const auto found = board->recover();
  ASSERT_TRUE(found) << found.error().message();
  expect_lights(desk, *board);
}

TEST(UsbBoard, IsSaidToBeGoneWhereOnlyAnotherIsThere) {
  Desk desk = Desk::with_usb();
  const auto board = opened(kNode);
  ASSERT_TRUE(board);
  desk.inject(VirtualBoardFault::kUnplug);
  const auto other = UsbTerminal::make(desk.folder(), 0, "another", "/dev/null");
  ASSERT_TRUE(other) << other.error().message();
  const auto found = board->recover();
  ASSERT_FALSE(found) << "another device was opened, which resets it";
  EXPECT_EQ(found.error().kind, ErrorKind::kNoDevice);
  EXPECT_THAT(found.error().message(), HasSubstr("no port is USB device 2341:0043 5573"));
  desk.inject(VirtualBoardFault::kElsewhere);
  EXPECT_TRUE(board->recover());
}

}  // namespace
}  // namespace weft::capture
