// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "app/daemon/client.h"
#include "app/daemon/rig_keeper.h"
#include "capture/board/led_board.h"
#include "capture/camera/camera_link.h"
#include "capture/rig.h"
#include "core/result.h"

namespace weft::app {

/// The devices that a rig file names; kTryAgain where another weft has them.
Result<std::unique_ptr<capture::LedBoard>> open_board(const capture::Rig& rig);
Result<std::unique_ptr<capture::CameraLink>> open_camera(const capture::Rig& rig);
Result<RigDevices> open_devices(const capture::Rig& rig);

/// The daemon that owns this rig, at the address of address_of_owner(), by token_of_owner().
Result<RigClient> connect_to_owner(const capture::Rig& rig, const std::string& address);

/// "firmware 1.0, 10 LEDs, began by power".
std::string words_of(const capture::BoardFacts& facts);

}  // namespace weft::app
