// SPDX-License-Identifier: Apache-2.0
// Other devices at the LED board's port, over a real terminal: what a person is told of each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>

#include "capture/board/flashing.h"
#include "capture/board/led_board.h"
#include "capture/board/port_talk.h"
#include "virtual_rig/board/virtual_board.h"
#include "virtual_rig/terminal/modem_lines.h"
#include "virtual_rig/terminal/port_name.h"
#include "virtual_rig/terminal/usb_terminal.h"

namespace weft::capture {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A device that is no LED board, at a terminal of its own.
class ForeignDevice {
 public:
  /// `answer` is given what came; `own` is sent every 0.2 s. `usb`: it is the USB device of an Uno.
  explicit ForeignDevice(std::function<std::string(const std::string&)> answer, std::string own = {},
                         bool usb = false)
      : folder_(std::filesystem::path(testing::TempDir()) / ("foreign_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    auto terminal = virtual_rig::PseudoTerminal::make(folder_ / "port");
    auto lines = virtual_rig::make_modem_lines(folder_ / "modem");
    EXPECT_TRUE(terminal && lines);
    terminal_ = std::move(*terminal);
    (*lines)->terminal = terminal_->device();
    setenv(virtual_rig::kModemVariable, (folder_ / "modem").c_str(), 1);
    if (usb) {
      usb_ = std::move(*virtual_rig::UsbTerminal::make(folder_, 0, "1", folder_ / "port"));
      setenv(virtual_rig::kMachineVariable, folder_.c_str(), 1);
    }
    thread_ = std::jthread([this, answer = std::move(answer),
                            own = std::move(own)](const std::stop_token& stop) { talk(stop, answer, own); });
  }
  ~ForeignDevice() {
    thread_.request_stop();
    thread_.join();
    unsetenv(virtual_rig::kModemVariable);
    unsetenv(virtual_rig::kMachineVariable);
    std::filesystem::remove_all(folder_);
  }
  std::string port() const { return virtual_rig::terminal_port_name(folder_ / "port"); }
  Error error() const {
    const auto board = LedBoard::open({port(), 0.4});
    return board ? Error{} : board.error();
  }

 private:
  void talk(const std::stop_token& stop, const std::function<std::string(const std::string&)>& answer,
            const std::string& own) const {
    const auto send = [this](const std::string& text) {
      terminal_->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    };
    auto next = std::chrono::steady_clock::now();
    while (!stop.stop_requested()) {
      std::array<std::uint8_t, 256> bytes = {};
      const std::size_t count = terminal_->read(bytes);
      if (count > 0 && answer)
        send(answer({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count)}));
      if (const auto now = std::chrono::steady_clock::now(); !own.empty() && now >= next) {
        send(own);
        next = now + std::chrono::milliseconds(200);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  std::filesystem::path folder_;
  std::unique_ptr<virtual_rig::PseudoTerminal> terminal_;
  std::unique_ptr<virtual_rig::UsbTerminal> usb_;
  std::jthread thread_;
};

std::string says(const std::string& text) {
  return ForeignDevice([text](const std::string&) { return text; }).error().message();
}

TEST(ForeignDevice, IsNamedByWhatItAnswers) {
  EXPECT_THAT(says("start\r\necho:Marlin 2.1\r\nok\r\n"),
              AllOf(HasSubstr("another device is at the LED board's port"), HasSubstr("a 3D printer answers"),
                    HasSubstr("\"start\", \"echo:Marlin 2.1\", \"ok\"")));
  EXPECT_THAT(says("// Klipper state: Ready\n"), HasSubstr("a 3D printer, by Klipper answers"));
  EXPECT_THAT(says("Grbl 1.1h ['$' for help]\r\n"), HasSubstr("a CNC or laser controller answers"));
  EXPECT_THAT(says("Temperature 21\xC2\xB0 C, humidity 40 percent\r\n"),
              HasSubstr("another firmware answers: \"Temperature 21\\xc2\\xb0 C, humidity 40 percent\""));
}

TEST(ForeignDevice, IsToldFromWhatSpeaksOfItsOwnAccord) {
  const ForeignDevice gps(nullptr, "$GPGGA,000000,0000.000,N*00\r\n");
  EXPECT_THAT(gps.error().message(),
              HasSubstr("a GPS receiver sends of its own accord: \"$GPGGA,000000,0000.000,N*00\""));
}

TEST(ForeignDevice, ThatEchoesIsCalledThatAndAModemBesides) {
  const ForeignDevice echo([](const std::string& said) { return said; });
  EXPECT_THAT(echo.error().message(),
              HasSubstr("a device that echoes, or a cable's loop, answers: what it was sent"));
  const ForeignDevice modem([](const std::string& said) { return said + "\r\nERROR\r\n"; });
  EXPECT_THAT(modem.error().message(), HasSubstr("a modem answers: \"ERROR\""));
}

TEST(ForeignDevice, ThatCannotBeReadMayBeOfAnotherSpeed) {
  const Error error =
      ForeignDevice([](const std::string&) { return std::string("\xE0\x1C\xFC\x00\x8F\x9E", 6); }).error();
  EXPECT_EQ(error.kind, ErrorKind::kTryAgain) << "a board is asked again after noise on its line";
  EXPECT_THAT(error.message(), AllOf(HasSubstr("neither a reply nor text: E0 1C FC 00 8F 9E E0"),
                                     HasSubstr("another speed than 115200 baud"), Not(HasSubstr("silent"))));
}

TEST(ForeignDevice, ThatIsABootloaderIsCalledSo) {
  EXPECT_THAT(says("\x14\x10"), AllOf(HasSubstr("the LED board's firmware does not start"),
                                      HasSubstr("a bootloader answers: 14 10")));
}

TEST(ForeignDevice, IsNeverToBeFlashedThoughItIsAnUnoByItsUsbNumbers) {
  const ForeignDevice printer([](const std::string&) { return "ok\r\n"; }, {}, true);
  const Error error = printer.error();
  EXPECT_EQ(error.kind, ErrorKind::kBadData);
  EXPECT_THAT(error.message(), AllOf(HasSubstr("USB 2341:0043"), Not(HasSubstr("flash"))));
  const auto may = may_be_flashed(printer.port(), 0.4);
  ASSERT_FALSE(may);
  EXPECT_THAT(may.error().message(), HasSubstr("3D printer"));
  EXPECT_THAT(may.error().remedy, HasSubstr("--any-board"));
}

TEST(SilentPort, MayBeFlashedByItsUsbIdentityAlone) {
  const ForeignDevice uno(nullptr, {}, true);
  EXPECT_TRUE(may_be_flashed(uno.port(), 0.2));
  for (const char* numbers : {"2341:0043", "2341:0001", "2341:0243", "2a03:0043", "1a86:7523", "0403:6001"}) {
    PortTalk silent;
    EXPECT_THAT(silent.no_board("/dev/p", {numbers, "", ""}, 4).remedy, HasSubstr("weft rig flash /dev/p"))
        << numbers;
  }
  for (const char* numbers : {"", "2341:0042", "10c4:ea60", "1d50:614e"}) {
    PortTalk silent;
    EXPECT_THAT(silent.no_board("/dev/p", {numbers, "", ""}, 4).message(), Not(HasSubstr("flash")))
        << numbers;
  }
}

TEST(SilentPort, OfNoUsbIdentityMayNotBeFlashed) {
  const ForeignDevice nobody(nullptr);
  const auto may = may_be_flashed(nobody.port(), 0.2);
  ASSERT_FALSE(may);
  EXPECT_THAT(may.error().message(), HasSubstr("no Arduino Uno or Nano by its USB identity"));
}

}  // namespace
}  // namespace weft::capture
