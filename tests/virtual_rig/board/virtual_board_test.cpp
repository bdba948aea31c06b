// SPDX-License-Identifier: Apache-2.0
// The virtual board by its bare terminal, without the host's library.
#include "virtual_rig/board/virtual_board.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>

#include "firmware/protocol/protocol.h"
#include "tests/capture/board/desk.h"
#include "tests/firmware/requests.h"

namespace weft::virtual_rig {
namespace {

using test::Bytes;
using test::Desk;
using test::light_request;
using test::request;

/// A terminal opened without any library.
class Terminal {
 public:
  /// Opened, and its board has started.
  explicit Terminal(const Desk& desk) : file_(open(desk.terminal().c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    EXPECT_TRUE(test::comes_true(3, [&] {
      send(request(200, kWeftHello));
      return !hear(30).empty();
    }));
    hear(30);
  }
  ~Terminal() { close(file_); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  bool send(const Bytes& bytes) const {
    return write(file_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  }
  /// What comes until nothing has come for `most_ms`.
  Bytes hear(int most_ms = 300) const {
    Bytes all;
    for (pollfd watched = {file_, POLLIN, 0}; poll(&watched, 1, all.empty() ? most_ms : 30) == 1;) {
      std::array<std::uint8_t, 256> bytes = {};
      const ssize_t count = read(file_, bytes.data(), bytes.size());
      if (count <= 0) break;
      all.insert(all.end(), bytes.begin(), bytes.begin() + count);
    }
    return all;
  }
  void set_speed(speed_t speed) const {
    termios settings = {};
    tcgetattr(file_, &settings);
    cfsetspeed(&settings, speed);
    tcsetattr(file_, TCSANOW, &settings);
  }

 private:
  int file_;
};

TEST(VirtualBoard, AnswersOnItsTerminal) {
  Desk desk;
  const Terminal terminal(desk);
  ASSERT_TRUE(terminal.send(request(1, kWeftHello)));
  const Bytes reply = terminal.hear();
  ASSERT_EQ(reply.size(), std::size_t{kWeftFrameHead + kWeftHelloReply + kWeftFrameCrc});
  EXPECT_EQ(reply[0], kWeftReplyStart);
  EXPECT_EQ(reply[kWeftFrameHead + 5] & kWeftResetPower, kWeftResetPower) << "reset cause";
}

TEST(VirtualBoard, LightsPinsAndSaysSoInTheLog) {
  Desk desk;
  const Terminal terminal(desk);
  terminal.send(light_request(1, 3, 10));
  ASSERT_TRUE(desk.comes_to_light({3}));
  ASSERT_TRUE(desk.comes_to_light({}));
  EXPECT_NEAR(desk.lit_s_since(RigClock::time_point()), 0.1, 0.005);
}

TEST(VirtualBoard, HearsNoOtherSpeed) {
  Desk desk;
  const Terminal terminal(desk);
  terminal.set_speed(B9600);
  terminal.send(request(1, kWeftHello));
  EXPECT_THAT(terminal.hear(150), testing::IsEmpty());
  terminal.set_speed(B115200);
  terminal.send(request(1, kWeftHello));
  EXPECT_FALSE(terminal.hear().empty());
}

TEST(VirtualBoard, TakesNoNoticeOfAHalfFrameAndOfAFlood) {
  Desk desk;
  const Terminal terminal(desk);
  const Bytes whole = light_request(1, 3, 100);
  terminal.send({whole.begin(), whole.end() - 1});
  EXPECT_THAT(terminal.hear(100), testing::IsEmpty());
  for (int i = 0; i < 10; ++i) terminal.send(Bytes(300, kWeftRequestStart));
  terminal.hear(500);
  EXPECT_EQ(desk.lit_s_since(RigClock::time_point()), 0);
  terminal.send(light_request(2, 4, 100));
  EXPECT_TRUE(desk.comes_to_light({4}));
}

TEST(VirtualBoard, GoesDarkWithoutItsHost) {
  Desk desk;
  const Terminal terminal(desk);
  terminal.send(light_request(1, 3, 400));
  ASSERT_TRUE(desk.comes_to_light({3}));
  ASSERT_TRUE(desk.comes_to_light({}));
  EXPECT_NEAR(desk.lit_s_since(RigClock::time_point()), 0.5, 0.01);
}

TEST(VirtualBoard, AHangEndsByTheWatchdogAndTheProgramIsWholeAfterwards) {
  Desk desk;
  const Terminal terminal(desk);
  for (int i = 0; i < 5; ++i) {
    terminal.send(light_request(i, 3, 400));
    ASSERT_TRUE(desk.comes_to_light({3}));
    terminal.hear();
    const auto before = RigClock::now();
    desk.inject(VirtualBoardFault::kHang);
    const auto hung = RigClock::now();
    const double still_s = desk.board().stood_still_s();
    ASSERT_TRUE(desk.comes_to_light({}));
    EXPECT_LE(desk.lit_s_since(hung), 0.3 + desk.board().stood_still_s() - still_s);
    EXPECT_GT(desk.lit_s_since(before), 0.1) << "that was no watchdog";
    terminal.send(request(i, kWeftHello));
    const Bytes reply = terminal.hear();
    ASSERT_EQ(reply.size(), std::size_t{kWeftFrameHead + kWeftHelloReply + kWeftFrameCrc});
    EXPECT_EQ(reply[kWeftFrameHead + 5], kWeftResetWatchdog);
  }
}

TEST(VirtualBoard, IsDarkAndDeafInItsBootloader) {
  Desk desk("firmware", 0.6);
  const Terminal terminal(desk);
  terminal.send(light_request(1, 3, 400));
  ASSERT_TRUE(desk.comes_to_light({3}));
  terminal.hear();
  desk.inject(VirtualBoardFault::kReset);
  EXPECT_EQ(desk.pins().now(), 0);
  terminal.send(request(2, kWeftHello));
  EXPECT_THAT(terminal.hear(150), testing::IsEmpty());
  ASSERT_TRUE(test::comes_true(2, [&] {
    terminal.send(request(3, kWeftHello));
    return !terminal.hear(50).empty();
  }));
}

TEST(VirtualBoard, TakesItsTerminalAlongWhenItIsUnplugged) {
  Desk desk;
  const Terminal terminal(desk);
  terminal.send(light_request(1, 3, 400));
  ASSERT_TRUE(desk.comes_to_light({3}));
  desk.inject(VirtualBoardFault::kUnplug);
  EXPECT_EQ(desk.pins().now(), 0);
  EXPECT_FALSE(std::filesystem::exists(desk.terminal()));
  EXPECT_FALSE(terminal.send(request(2, kWeftHello)));
  desk.inject(VirtualBoardFault::kReplug);
  const Terminal another(desk);
  another.send(request(2, kWeftHello));
  const Bytes reply = another.hear();
  ASSERT_FALSE(reply.empty());
  EXPECT_EQ(reply[kWeftFrameHead + 5] & kWeftResetPower, kWeftResetPower);
}

TEST(VirtualBoard, RemembersThroughAResetHowHotItsLedsAre) {
  Desk desk("firmware", 0.0);
  const Terminal terminal(desk);
  terminal.send(light_request(1, 3, 400));
  ASSERT_TRUE(desk.comes_to_light({3}));
  terminal.hear();
  ASSERT_TRUE(desk.comes_to_light({}));  // half a second of heat, by the dead-man timer
  desk.inject(VirtualBoardFault::kReset);
  Bytes reply;
  ASSERT_TRUE(test::comes_true(2, [&] {
    terminal.send(light_request(2, 3, kWeftMostOn_cs));
    reply = terminal.hear(50);
    return !reply.empty();
  }));
  ASSERT_EQ(reply[3], kWeftError | kWeftReplyBit) << "lit for the full time though it is warm";
  EXPECT_EQ(reply[4], kWeftResting);
  EXPECT_EQ(desk.pins().now(), 0);
}

TEST(VirtualBoard, RefusesAFileThatIsNoFirmware) {
  LitLog pins;
  const std::string folder = testing::TempDir();
  const auto board = VirtualBoard::start({"/dev/null", folder + "no_led", folder + "no_modem"}, pins);
  ASSERT_FALSE(board);
  EXPECT_EQ(board.error().kind, ErrorKind::kNoInput) << board.error().message();
  EXPECT_FALSE(std::filesystem::exists(folder + "no_modem"));
}

}  // namespace
}  // namespace weft::virtual_rig
