// SPDX-License-Identifier: Apache-2.0
#include "bench/server/studies.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/server/crowd.h"
#include "bench/server/served_rig.h"
#include "bench/server/wide_solve.h"
#include "core/json_document.h"
#include "core/statistics.h"

namespace weft::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kBetweenQuestions(50);
constexpr int kLeast = 19;  // niceness

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

/// Ask for tiles until they go.
class Viewers {
 public:
  /// `calls` must outlive them.
  Viewers(const ServedRig& served, int count, const std::vector<std::string>& calls) {
    for (int i = 0; i < count; ++i) {
      threads_.emplace_back([&served, &calls, i](const std::stop_token& stop) {
        // They sit at other machines, and take nothing from this one's processor but what is left.
        setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLeast);
        for (std::size_t k = static_cast<std::size_t>(i); !stop.stop_requested(); ++k)
          static_cast<void>(served.client().bytes(calls[k % calls.size()]).has_value());
      });
    }
  }

 private:
  std::vector<std::jthread> threads_;
};

/// The calls for tiles of a solve that is written beside the rig's own sessions, each answered once.
Result<std::vector<std::string>> tiles_to_look_at(const ServedRig& served, std::uint64_t seed) {
  constexpr int kMegapixels = 16, kTiles = 200;
  const Result<Json> next = served.client().get("/api/v1/next-name?fabric=wide");
  if (!next) return next.error();
  const std::filesystem::path sessions =
      std::filesystem::path(next->at("folder").get<std::string>()).parent_path();
  const Size size = wide_size(kMegapixels);
  if (Result<void> ok = write_wide_solve(sessions, size); !ok) return std::move(ok).error();
  std::vector<std::string> calls = wide_tiles(size, kTiles, seed);
  for (const std::string& call : calls) {
    if (const Result<std::string> tile = served.client().bytes(call); !tile) return tile.error();
  }
  return calls;
}

Result<Rows> scans_beside(const StudyOptions& options, int viewer_count) {
  ServedRig served;
  if (Result<void> ok = served.start(options.programs, options.scenes / "satin.toml", options.megapixels);
      !ok)
    return std::move(ok).error();
  if (Result<void> ok = served.serve(); !ok) return std::move(ok).error();
  if (const Result<ScanTime> first = time_of_scan(served); !first) return first.error();  // watches the clock
  std::vector<std::string> calls;
  if (viewer_count > 0) {
    Result<std::vector<std::string>> tiles = tiles_to_look_at(served, options.seed);
    if (!tiles) return std::move(tiles).error();
    calls = std::move(*tiles);
  }
  std::vector<double> alone, beside, ratios, answers_ms;
  for (int turn = 0; turn < options.runs; ++turn) {
    const Result<ScanTime> quiet = time_of_scan(served);
    if (!quiet) return quiet.error();
    Crowd crowd(served.port());
    std::optional<Viewers> viewers;
    if (viewer_count > 0) {
      viewers.emplace(served, viewer_count, calls);
    } else {
      if (Result<void> there = crowd.stay_silent(); !there) return std::move(there).error();
      crowd.read_slowly();
      crowd.send_malformed(options.seed + static_cast<std::uint64_t>(turn));
    }
    const Result<ScanTime> loud = time_of_scan(served);
    if (!loud) return loud.error();
    alone.push_back(quiet->seconds);
    beside.push_back(loud->seconds);
    ratios.push_back(loud->seconds / quiet->seconds);
    answers_ms.insert(answers_ms.end(), loud->answers_ms.begin(), loud->answers_ms.end());
    options.progress(turn + 1, options.runs);
  }
  return Rows{{{"turns", options.runs},
               {"alone_s", median(alone)},
               {"beside_s", median(beside)},
               {"ratio", median(ratios)},
               {"median_ms", median(answers_ms)},
               {"most_ms", *std::ranges::max_element(answers_ms)}}};
}

}  // namespace

/// What clients cost a scan: in turn one alone, and one beside those who mean ill (malformed requests one
/// after another, silent clients, slow readers; crowd.h) or beside viewers, each asking for one tile after
/// another. One row: "turns", "alone_s" and "beside_s" (median), "ratio" (median of the pairs), "median_ms"
/// and "most_ms" of GET /api/v1/rig every 50 ms beside them.
/// Errors: of the rig's and the daemon's start, and of a scan.
Result<Rows> scan_beside_table(const StudyOptions& options) {
  return scans_beside(options, 0);
}

Result<Rows> viewers_table(const StudyOptions& options) {
  return scans_beside(options, 2);
}

}  // namespace weft::bench
