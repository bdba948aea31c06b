// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/terminal/port_name.h"

namespace weft::virtual_rig {

std::string terminal_port_name(const std::filesystem::path& link) {
  return "/dev/../../.." + std::filesystem::absolute(link).lexically_normal().string();
}

}  // namespace weft::virtual_rig
