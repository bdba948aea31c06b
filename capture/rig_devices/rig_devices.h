// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "capture/board/led_board.h"
#include "capture/camera/camera_link.h"
#include "capture/devices.h"
#include "capture/rig.h"
#include "core/base/result.h"

namespace weft::capture {

/// The opened devices of a rig.
struct RigDevices {
  std::unique_ptr<Lamps> lamps;
  std::unique_ptr<Camera> camera;
};
using OpenDevices = std::function<Result<RigDevices>(const Rig&)>;

/// The devices that a rig file names; kTryAgain where another weft has them.
Result<std::unique_ptr<LedBoard>> open_board(const Rig& rig);
Result<std::unique_ptr<CameraLink>> open_camera(const Rig& rig);
Result<RigDevices> open_devices(const Rig& rig);

}  // namespace weft::capture
