// SPDX-License-Identifier: Apache-2.0
#include "capture/rig_devices/rig_devices.h"

#include <utility>

namespace weft::capture {

Result<std::unique_ptr<LedBoard>> open_board(const Rig& rig) {
  return LedBoard::open({.port = rig.board.port});
}

Result<std::unique_ptr<CameraLink>> open_camera(const Rig& rig) {
  return CameraLink::make({.profile = rig.camera.profile,
                           .port = rig.camera.port,
                           .serial = camera_serial(rig),
                           .worker = {},
                           .state = rig.daemon.state / "camera",
                           .environment = {}});
}

Result<RigDevices> open_devices(const Rig& rig) {
  auto board = open_board(rig);
  if (!board) return std::move(board).error();
  auto camera = open_camera(rig);
  if (!camera) return std::move(camera).error();
  return RigDevices{std::move(*board), std::move(*camera)};
}

}  // namespace weft::capture
