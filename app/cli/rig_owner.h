// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/server/http/client.h"
#include "app/server/rig_server.h"
#include "capture/board/led_board.h"
#include "capture/rig.h"
#include "core/base/result.h"

namespace weft::app {

/// The daemon that owns this rig, at the address of address_of_owner(), by token_of_owner().
Result<RigClient> connect_to_owner(const capture::Rig& rig, const std::string& address);

/// A rig behind its interface: the daemon that owns it, or a server in this process for as long as this
/// lives.
struct ReachedRig {
  std::unique_ptr<RigServer> own;  ///< null where a daemon runs
  RigClient client;
};
/// `owner`: as address_of_owner() says.
Result<ReachedRig> reach_rig(capture::Rig rig, const std::optional<std::string>& owner);

/// "firmware 1.0, 10 LEDs, began from power-on", and what to do about a board of older firmware at that port.
std::string words_of(const capture::BoardFacts& facts, const std::string& port);

}  // namespace weft::app
