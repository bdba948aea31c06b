// SPDX-License-Identifier: Apache-2.0
#include "bench/server/scan_beside.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/server/crowd.h"
#include "bench/server/served_rig.h"
#include "core/json_document.h"
#include "core/statistics.h"

namespace weft::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kBetweenQuestions(50);

/// One scan to its end, asked about all the while.
struct ScanTime {
  double seconds = 0;
  std::vector<double> answers_ms;
};

Result<ScanTime> time_of_scan(const ServedRig& served) {
  const auto begin = Clock::now();
  const Result<Json> begun =
      served.client().post("/api/v1/scan", {{"fabric", "bench"}, {"exposure_us", 20000}});
  if (!begun) return begun.error();
  ScanTime time;
  for (;; std::this_thread::sleep_for(kBetweenQuestions)) {
    const auto asked = Clock::now();
    const Result<Json> status = served.client().get("/api/v1/rig");
    if (!status) return status.error();
    time.answers_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - asked).count());
    const std::string state = status->at("state").get<std::string>();
    if (state == "failed") {
      return Error{ErrorKind::kTryAgain, "a scan failed", "bench", status->at("why").get<std::string>(),
                   "run the benchmark again"};
    }
    if (state == "idle") break;
  }
  time.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return time;
}

}  // namespace

Result<Rows> scan_beside_table(const ScanBesideOptions& options) {
  ServedRig served;
  if (Result<void> ok = served.start(options.programs, options.scene, options.megapixels); !ok)
    return std::move(ok).error();
  if (Result<void> ok = served.serve(); !ok) return std::move(ok).error();
  if (const Result<ScanTime> first = time_of_scan(served); !first) return first.error();  // watches the clock
  std::vector<double> alone, beside, ratios, answers_ms;
  for (int turn = 0; turn < options.turns; ++turn) {
    const Result<ScanTime> quiet = time_of_scan(served);
    if (!quiet) return quiet.error();
    Crowd crowd(served.port());
    if (Result<void> there = crowd.stay_silent(options.silent); !there) return std::move(there).error();
    crowd.read_slowly(options.slow);
    crowd.send_malformed(options.malformed, options.seed + static_cast<std::uint64_t>(turn));
    const Result<ScanTime> loud = time_of_scan(served);
    if (!loud) return loud.error();
    alone.push_back(quiet->seconds);
    beside.push_back(loud->seconds);
    ratios.push_back(loud->seconds / quiet->seconds);
    answers_ms.insert(answers_ms.end(), loud->answers_ms.begin(), loud->answers_ms.end());
    options.progress(turn + 1, options.turns);
  }
  return Rows{{{"turns", options.turns},
               {"alone_s", median(alone)},
               {"beside_s", median(beside)},
               {"ratio", median(ratios)},
               {"median_ms", median(answers_ms)},
               {"most_ms", *std::ranges::max_element(answers_ms)}}};
}

}  // namespace weft::bench
