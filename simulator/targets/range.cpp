// SPDX-License-Identifier: Apache-2.0
#include "simulator/targets/range.h"

#include <fmt/format.h>

namespace weft::simulator {

Result<void> check(std::initializer_list<NamedSetting> settings) {
  for (const auto& [name, value, range] : settings) {
    if (value >= range.least && value <= range.most) continue;
    return Error{ErrorKind::kBadData, "a target's setting is out of its range", name,
                 fmt::format("it is {}", value),
                 fmt::format("give a number from {} to {}", range.least, range.most)};
  }
  return {};
}

}  // namespace weft::simulator
