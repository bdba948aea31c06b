// SPDX-License-Identifier: Apache-2.0
#include "bench/server/studies.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/server/http/client.h"
#include "bench/server/crowd.h"
#include "bench/server/no_devices.h"
#include "core/statistics.h"
#include "core/temporary_folder.h"

namespace weft::bench {
namespace {

struct Beside {
  bool malformed = false, silent = false, slow = false;
};

Result<Json> row_of(const app::RigClient& client, int port, const Beside& beside,
                    const StudyOptions& options) {
  Crowd crowd(port);
  if (beside.silent) {
    if (Result<void> there = crowd.stay_silent(); !there) return std::move(there).error();
  }
  if (beside.slow) crowd.read_slowly();
  if (beside.slow) std::this_thread::sleep_for(std::chrono::milliseconds(500));
  if (beside.malformed) crowd.send_malformed(options.seed);
  std::vector<double> times_ms;
  while (static_cast<int>(times_ms.size()) < options.runs || crowd.sending()) {
    const auto begin = std::chrono::steady_clock::now();
    const Result<Json> answer = client.get("/api/v1/rig");
    const std::chrono::duration<double, std::milli> time_ms = std::chrono::steady_clock::now() - begin;
    if (!answer) return answer.error();
    times_ms.push_back(time_ms.count());
  }
  return Json{{"malformed", beside.malformed ? Crowd::kMalformed : 0},
              {"silent", beside.silent ? Crowd::kSilent : 0},
              {"slow", beside.slow ? Crowd::kSlow : 0},
              {"requests", times_ms.size()},
              {"median_ms", median(times_ms)},
              {"most_ms", *std::ranges::max_element(times_ms)}};
}

}  // namespace

/// How long a daemon without devices takes for GET /api/v1/rig on a connection of its own, median and worst
/// in ms: undisturbed; beside malformed requests one after another; beside silent clients, every second one
/// of them in the middle of its request; beside slow readers, who ask for openapi.json twenty times at once
/// and take 40 kB a second of it; beside all of them. Errors: those of RigServer::start() and
/// RigClient::connect(), kTryAgain where a client cannot connect.
Result<Rows> door_table(const StudyOptions& options) {
  const TemporaryFolder folder;
  const auto server = server_without_devices("bench", folder.path() / "scans", folder.path() / "state");
  if (!server) return server.error();
  const Result<app::RigClient> client = app::RigClient::connect((*server)->address());
  if (!client) return client.error();
  Rows rows;
  for (const Beside& beside : {Beside{}, Beside{.malformed = true}, Beside{.silent = true},
                               Beside{.slow = true}, Beside{true, true, true}}) {
    Result<Json> row = row_of(*client, (*server)->port(), beside, options);
    if (!row) return std::move(row).error();
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace weft::bench
