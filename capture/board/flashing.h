// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/base/result.h"

namespace weft::capture {

/// Whether the port may be given the LED board's firmware: its USB identity is that of boards that the
/// firmware runs on, and no other device was understood there. It is reset and asked, `listen_s` at most.
/// Errors: those of opening a serial port; kBadData with what is there instead.
Result<void> may_be_flashed(const std::string& port, double listen_s = 4);

}  // namespace weft::capture
