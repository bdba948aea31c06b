// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace weft::virtual_rig {

/// The name by which libserialport 0.1.1 opens a link to a pseudo-terminal. It takes names below /dev only,
/// and asks for the same name below /sys/class/tty: this one climbs out of both to the link.
std::string terminal_port_name(const std::filesystem::path& link);

}  // namespace weft::virtual_rig
