// SPDX-License-Identifier: Apache-2.0
#include "app/cli/rig_owner.h"

#include <fmt/format.h>

#include "app/server/rig/rig_lock.h"

namespace weft::app {

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
