// SPDX-License-Identifier: Apache-2.0
#include "bench/server/door.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/server/http/client.h"
#include "app/server/rig_server.h"
#include "bench/server/crowd.h"
#include "core/statistics.h"
#include "core/temporary_folder.h"

namespace weft::bench {
namespace {

struct Beside {
  bool malformed = false, silent = false, slow = false;
};

Result<Json> row_of(const app::RigClient& client, int port, const Beside& beside,
                    const DoorOptions& options) {
  Crowd crowd(port);
  if (beside.silent) {
    if (Result<void> there = crowd.stay_silent(options.silent); !there) return std::move(there).error();
  }
  if (beside.slow) crowd.read_slowly(options.slow);
  if (beside.slow) std::this_thread::sleep_for(std::chrono::milliseconds(500));
  if (beside.malformed) crowd.send_malformed(options.malformed, options.seed);
  std::vector<double> times_ms;
  while (static_cast<int>(times_ms.size()) < options.requests || crowd.sending()) {
    const auto begin = std::chrono::steady_clock::now();
    const Result<Json> answer = client.get("/api/v1/rig");
    const std::chrono::duration<double, std::milli> time_ms = std::chrono::steady_clock::now() - begin;
    if (!answer) return answer.error();
    times_ms.push_back(time_ms.count());
  }
  return Json{{"malformed", beside.malformed ? options.malformed : 0},
              {"silent", beside.silent ? options.silent : 0},
              {"slow", beside.slow ? options.slow : 0},
              {"requests", times_ms.size()},
              {"median_ms", median(times_ms)},
              {"most_ms", *std::ranges::max_element(times_ms)}};
}

}  // namespace

Result<Rows> door_table(const DoorOptions& options) {
  const TemporaryFolder folder;
  capture::Rig rig;
  rig.name = "bench";
  rig.scan.sessions = folder.path() / "scans";
  rig.daemon.port = 0;
  rig.daemon.state = folder.path() / "state";
  const Error no_devices = {ErrorKind::kTryAgain, "this rig has no devices", rig.name, "", "name another"};
  const Result<std::unique_ptr<app::RigServer>> server = app::RigServer::start(
      rig, [&](const capture::Rig&) -> Result<capture::RigDevices> { return no_devices; },
      [&](const capture::ScanRequest&, capture::Lamps&, capture::Camera&, const capture::ScanEvents&,
          const capture::ScanControl&) -> Result<capture::ScanOutcome> { return no_devices; });
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
