// SPDX-License-Identifier: Apache-2.0
#include "app/cli/rig_owner.h"

#include <fmt/format.h>

#include "app/server/rig/rig_lock.h"
#include "capture/rig_devices/rig_devices.h"
#include "capture/scan/scan.h"

namespace weft::app {

Result<RigClient> connect_to_owner(const capture::Rig& rig, const std::string& address) {
  const Result<std::string> token = token_of_owner(rig);
  if (!token) return token.error();
  return RigClient::connect(address, *token);
}

Result<ReachedRig> reach_rig(capture::Rig rig, const std::optional<std::string>& owner) {
  if (owner) {
    Result<RigClient> client = connect_to_owner(rig, *owner);
    if (!client) return std::move(client).error();
    return ReachedRig{nullptr, std::move(*client)};
  }
  rig.daemon.host = "127.0.0.1";
  rig.daemon.port = 0;
  auto server = RigServer::start(
      rig, capture::open_devices,
      [](const auto& request, auto& lamps, auto& camera, const auto& events, const auto& control) {
        return capture::scan(request, lamps, camera, events, control);
      },
      {.own_token = true});
  if (!server) return std::move(server).error();
  Result<RigClient> client = RigClient::connect((*server)->address(), (*server)->token());
  if (!client) return std::move(client).error();
  return ReachedRig{std::move(*server), std::move(*client)};
}

std::string words_of(const capture::BoardFacts& facts, const std::string& port) {
  const std::string advice = capture::firmware_advice(facts, port);
  return fmt::format("firmware {}.{}, {} LEDs, began from {}{}{}", facts.firmware_major, facts.firmware_minor,
                     facts.leds, capture::name_of(facts.reset), advice.empty() ? "" : "; ", advice);
}

}  // namespace weft::app
