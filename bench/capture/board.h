// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct CaptureBoardOptions {
  std::string port;  ///< of a LED board that nothing else holds: a real one, or that of a running virtual rig
  int commands = 10'000;
};

/// One row: commands sent, lost, their median, 99th percentile and greatest time in ms, and what the board
/// itself counts as bad frames and overruns. Lights every LED in turn. Errors: those of LedBoard::open().
Result<Rows> capture_board_table(const CaptureBoardOptions& options);

}  // namespace weft::bench
