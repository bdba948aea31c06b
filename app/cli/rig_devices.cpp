// SPDX-License-Identifier: Apache-2.0
#include "app/cli/rig_devices.h"

#include <fmt/format.h>

#include <utility>

#include "app/daemon/rig_lock.h"

namespace weft::app {

Result<std::unique_ptr<capture::LedBoard>> open_board(const capture::Rig& rig) {
  return capture::LedBoard::open({.port = rig.board.port});
}

Result<std::unique_ptr<capture::CameraLink>> open_camera(const capture::Rig& rig) {
  return capture::CameraLink::make({.profile = rig.camera.profile,
                                    .port = rig.camera.port,
                                    .serial = capture::camera_serial(rig),
                                    .worker = {},
                                    .state = rig.daemon.state / "camera",
                                    .environment = {}});
}

Result<RigDevices> open_devices(const capture::Rig& rig) {
  auto board = open_board(rig);
  if (!board) return std::move(board).error();
  auto camera = open_camera(rig);
  if (!camera) return std::move(camera).error();
  return RigDevices{std::move(*board), std::move(*camera)};
}

Result<RigClient> connect_to_owner(const capture::Rig& rig, const std::string& address) {
  const Result<std::string> token = token_of_owner(rig);
  if (!token) return token.error();
  return RigClient::connect(address, *token);
}

std::string words_of(const capture::BoardFacts& facts) {
  return fmt::format("firmware {}.{}, {} LEDs, began from {}", facts.firmware_major, facts.firmware_minor,
                     facts.leds, capture::name_of(facts.reset));
}

}  // namespace weft::app
