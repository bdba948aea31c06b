// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string_view>

namespace weft::app {

/// Tells the service manager that started this process, if one did: "READY=1", "WATCHDOG=1", "STOPPING=1",
/// "STATUS=..." (sd_notify(3): a datagram to the socket in NOTIFY_SOCKET).
void tell_service_manager(std::string_view message);

/// How often it wants to hear WATCHDOG=1: half of WATCHDOG_USEC; nothing where it does not care.
std::optional<std::chrono::milliseconds> watchdog_interval();

}  // namespace weft::app
