// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct DoorOptions {
  int requests = 200;  ///< of each row at least
  int malformed = 1000, silent = 64, slow = 32;
  std::uint64_t seed = 1;  ///< of what is wrong
};

/// How long a daemon without devices takes for GET /api/v1/rig on a connection of its own, median and worst
/// in ms: undisturbed; beside malformed requests one after another; beside silent clients, every second one
/// of them in the middle of its request; beside slow readers, who ask for openapi.json twenty times at once
/// and take 40 kB a second of it; beside all of them. Errors: those of RigServer::start() and
/// RigClient::connect(), kTryAgain where a client cannot connect.
Result<Rows> door_table(const DoorOptions& options);

}  // namespace weft::bench
