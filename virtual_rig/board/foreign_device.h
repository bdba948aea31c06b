// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/base/result.h"
#include "virtual_rig/board/virtual_board.h"
#include "virtual_rig/terminal/modem_lines.h"

namespace weft::virtual_rig {

/// How a device talks that is no LED board.
struct ForeignTalk {
  std::function<std::string(const std::string&)> answer;  ///< to what came; none: it never answers
  std::string own;                                        ///< sent of its own accord, five times a second
};

/// "gps", "printer", "modem", "echo", "silent".
const std::vector<std::string>& foreign_kinds();
/// How one of these talks.
ForeignTalk talk_of_foreign(const std::string& kind);

/// Another device at a serial port of the host: a terminal of its own, with modem lines for the shim.
class ForeignDevice {
 public:
  static Result<std::unique_ptr<ForeignDevice>> start(const std::filesystem::path& terminal,
                                                      const std::filesystem::path& modem, ForeignTalk talk);
  ~ForeignDevice() = default;  ///< its port goes
  ForeignDevice(const ForeignDevice&) = delete;
  ForeignDevice& operator=(const ForeignDevice&) = delete;

 private:
  ForeignDevice(std::unique_ptr<PseudoTerminal> terminal, SharedModemLines modem, ForeignTalk talk);
  void send(const std::string& text) const;
  void live(const std::stop_token& stop) const;

  std::unique_ptr<PseudoTerminal> terminal_;
  SharedModemLines modem_;
  ForeignTalk talk_;
  std::jthread thread_;  // last: ends before what it uses
};

}  // namespace weft::virtual_rig
