// SPDX-License-Identifier: Apache-2.0
#include "capture/board/flashing.h"

#include <utility>

#include "capture/board/board_wire.h"

namespace weft::capture {

Result<void> may_be_flashed(const std::string& port, double listen_s) {
  auto opened = SerialPort::open(port);
  if (!opened) return std::move(opened).error();
  BoardWire wire(std::move(*opened));
  const UsbDevice usb = wire.port().usb();
  if (!may_be_led_board(usb)) {
    return Error{ErrorKind::kBadData, "this is no Arduino Uno or Nano by its USB identity", port,
                 usb.numbers.empty() ? "it is not known" : "it is " + usb.numbers,
                 "name the LED board's port; where you know better, --any-board flashes it"};
  }
  const auto reply = wire.greet(listen_s);
  if (reply || !wire.talk().is_foreign()) return {};
  Error error = reply.error();
  error.remedy = "name the LED board's port; where it is to become the LED board, --any-board flashes it";
  return error;
}

}  // namespace weft::capture
