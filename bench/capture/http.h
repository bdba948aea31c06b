// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct CaptureHttpOptions {
  int requests = 200;  ///< of each row
  int malformed = 1000, silent = 64;
  std::uint64_t seed = 1;  ///< of what is wrong
};

/// Two rows of how long a daemon without devices takes for GET /api/v1/rig on a connection of its own, median
/// and worst in ms: undisturbed; then after malformed requests, with silent clients connected, every second
/// one of them in the middle of its request. Errors: those of RigServer::start() and RigClient::connect(),
/// kTryAgain where a client cannot connect.
Result<Rows> capture_http_table(const CaptureHttpOptions& options);

}  // namespace weft::bench
