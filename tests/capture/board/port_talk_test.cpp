// SPDX-License-Identifier: Apache-2.0
// Other devices at the LED board's port, over a real terminal: what a person is told of each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "capture/board/flashing.h"
#include "capture/board/led_board.h"
#include "capture/board/port_talk.h"
#include "tests/capture/board/desk.h"
#include "virtual_rig/board/foreign_device.h"
#include "virtual_rig/terminal/modem_lines.h"
#include "virtual_rig/terminal/port_name.h"
#include "virtual_rig/terminal/usb_terminal.h"

namespace weft::capture {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A device that is no LED board at the port that a host opens.
class DeviceAtThePort {
 public:
  /// `usb`: it is the USB device of an Uno.
  explicit DeviceAtThePort(virtual_rig::ForeignTalk talk, bool usb = false)
      : folder_(std::filesystem::path(testing::TempDir()) / ("foreign_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    auto device = virtual_rig::ForeignDevice::start(folder_ / "port", folder_ / "modem", std::move(talk));
    EXPECT_TRUE(device);
    device_ = std::move(*device);
    setenv(virtual_rig::kModemVariable, (folder_ / "modem").c_str(), 1);
    if (usb) {
      usb_ = std::move(*virtual_rig::UsbTerminal::make(folder_, 0, "1", folder_ / "port"));
      setenv(virtual_rig::kMachineVariable, folder_.c_str(), 1);
    }
  }
  ~DeviceAtThePort() {
    device_.reset();
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
  std::filesystem::path folder_;
  std::unique_ptr<virtual_rig::ForeignDevice> device_;
  std::unique_ptr<virtual_rig::UsbTerminal> usb_;
};

virtual_rig::ForeignTalk answering(const std::string& text) {
  return {[text](const std::string&) { return text; }, ""};
}

std::string says(const std::string& text) {
  return DeviceAtThePort(answering(text)).error().message();
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
  const DeviceAtThePort gps({nullptr, "$GPGGA,000000,0000.000,N*00\r\n"});
  EXPECT_THAT(gps.error().message(),
              HasSubstr("a GPS receiver sends of its own accord: \"$GPGGA,000000,0000.000,N*00\""));
}

TEST(ForeignDevice, ThatEchoesIsCalledThatAndAModemBesides) {
  const DeviceAtThePort echo(virtual_rig::talk_of_foreign("echo"));
  EXPECT_THAT(echo.error().message(),
              HasSubstr("a device that echoes, or a cable's loop, answers: what it was sent"));
  const DeviceAtThePort modem(virtual_rig::talk_of_foreign("modem"));
  EXPECT_THAT(modem.error().message(), HasSubstr("a modem answers: \"ERROR\""));
}

TEST(ForeignDevice, ThatCannotBeReadMayBeOfAnotherSpeed) {
  const Error error = DeviceAtThePort(answering(std::string("\xE0\x1C\xFC\x00\x8F\x9E", 6))).error();
  EXPECT_EQ(error.kind, ErrorKind::kTryAgain) << "a board is asked again after noise on its line";
  EXPECT_THAT(error.message(), AllOf(HasSubstr("neither a reply nor text: E0 1C FC 00 8F 9E E0"),
                                     HasSubstr("another speed than 115200 baud"), Not(HasSubstr("silent"))));
}

TEST(ForeignDevice, ThatIsABootloaderIsCalledSo) {
  EXPECT_THAT(says("\x14\x10"), AllOf(HasSubstr("the LED board's firmware does not start"),
                                      HasSubstr("a bootloader answers: 14 10")));
}

TEST(ForeignDevice, IsNeverToBeFlashedThoughItIsAnUnoByItsUsbNumbers) {
  const DeviceAtThePort printer(answering("ok\r\n"), true);
  const Error error = printer.error();
  EXPECT_EQ(error.kind, ErrorKind::kBadData);
  EXPECT_THAT(error.message(), AllOf(HasSubstr("USB 2341:0043"), Not(HasSubstr("flash"))));
  const auto may = may_be_flashed(printer.port(), 0.4);
  ASSERT_FALSE(may);
  EXPECT_THAT(may.error().message(), HasSubstr("3D printer"));
  EXPECT_THAT(may.error().remedy, HasSubstr("--any-board"));
}

TEST(DeviceAtThePort, IsToldWithThePortsWhereTheBoardMayBe) {
  const test::Desk desk = test::Desk::with_usb();
  const auto gps = virtual_rig::ForeignDevice::start(desk.folder() / "gps", desk.folder() / "gps_modem",
                                                     virtual_rig::talk_of_foreign("gps"));
  ASSERT_TRUE(gps);
  setenv(virtual_rig::kModemVariable,
         ((desk.folder() / "modem").string() + ":" + (desk.folder() / "gps_modem").string()).c_str(), 1);
  const auto usb = virtual_rig::UsbTerminal::make(desk.folder(), 1, "9", desk.folder() / "gps");
  ASSERT_TRUE(usb);
  const auto other = LedBoard::open({"/dev/ttyACM1", 0.4});
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message(), AllOf(HasSubstr("a GPS receiver sends of its own accord"),
                                             HasSubstr("LED boards may be at /dev/ttyACM0")));
  EXPECT_TRUE(LedBoard::open({"/dev/ttyACM0"})) << "where it is";
}

TEST(SilentPort, MayBeFlashedByItsUsbIdentityAlone) {
  const DeviceAtThePort uno({}, true);
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
  const DeviceAtThePort nobody({});
  const auto may = may_be_flashed(nobody.port(), 0.2);
  ASSERT_FALSE(may);
  EXPECT_THAT(may.error().message(), HasSubstr("no Arduino Uno or Nano by its USB identity"));
}

}  // namespace
}  // namespace weft::capture
