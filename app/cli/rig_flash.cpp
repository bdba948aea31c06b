// SPDX-License-Identifier: Apache-2.0
// weft rig flash: the firmware that this weft carries, onto the board at a port.
#include "app/cli/rig_flash.h"

#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <string>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/rig_owner.h"
#include "app/cli/terminal.h"
#include "capture/board/flashing.h"
#include "capture/board/led_board.h"
#include "core/base/files.h"
#include "core/base/process.h"
#include "core/base/temporary_folder.h"

namespace weft::app {
namespace {

struct Flashing {
  std::string port;
  bool any_board = false;
};

Result<void> run_avrdude(const std::string& port) {
  const TemporaryFolder scratch;
  const std::string hex = scratch.path() / "firmware.hex";
  if (Result<void> written = write_file(hex, carried_firmware()); !written) return written;
  const auto avrdude = ChildProcess::start({.command = {"avrdude", "-c", "arduino", "-p", "m328p", "-P", port,
                                                        "-b", "115200", "-D", "-U", "flash:w:" + hex + ":i"},
                                            .output = STDERR_FILENO,
                                            .errors = STDERR_FILENO});
  if (!avrdude) {
    Error error = avrdude.error();
    if (error.kind == ErrorKind::kNoInput) error.remedy = "sudo apt-get install avrdude";
    return error;
  }
  if (const int code = (*avrdude)->wait(); code != 0) {
    return Error{
        ErrorKind::kProtocol, "the board was not flashed", port,
        fmt::format("avrdude ended with exit code {}", code),
        "press the board's reset button just as it begins; a Nano with the old bootloader needs Optiboot "
        "(docs/rig.md)"};
  }
  return {};
}

Result<int> flash(const Flashing& a, const CommonArguments& common) {
  if (!a.any_board) {
    if (Result<void> may = capture::may_be_flashed(a.port); !may) return std::move(may).error();
  }
  if (Result<void> flashed = run_avrdude(a.port); !flashed) return std::move(flashed).error();
  const auto board = capture::LedBoard::open({a.port});
  if (!board) return board.error();
  const capture::BoardFacts facts = (*board)->facts();
  if (common.json) {
    print_json({{"port", a.port},
                {"firmware", fmt::format("{}.{}", facts.firmware_major, facts.firmware_minor)},
                {"leds", facts.leds}});
  } else {
    print(fmt::format("board   {}: {}", a.port, words_of(facts, a.port)));
  }
  return kDone;
}

}  // namespace

Run add_rig_flash(Options& options) {
  const auto a = std::make_shared<Flashing>();
  options.add("port", &a->port, "Port of the board, as /dev/ttyACM0").required();
  options.add_flag("--any-board", &a->any_board,
                   "Whatever its USB identity is, and whatever answers there; its program is overwritten");
  return [a](const CommonArguments& common) { return flash(*a, common); };
}

}  // namespace weft::app
