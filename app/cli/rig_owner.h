// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/server/http/client.h"
#include "capture/board/led_board.h"
#include "capture/rig.h"
#include "core/result.h"

namespace weft::app {

/// The daemon that owns this rig, at the address of address_of_owner(), by token_of_owner().
Result<RigClient> connect_to_owner(const capture::Rig& rig, const std::string& address);

/// "firmware 1.0, 10 LEDs, began by power".
std::string words_of(const capture::BoardFacts& facts);

}  // namespace weft::app
