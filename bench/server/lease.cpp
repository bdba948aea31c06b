// SPDX-License-Identifier: Apache-2.0
#include "bench/server/studies.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/server/served_rig.h"
#include "core/statistics.h"

namespace weft::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr double kDark_s = 2;       // asked for
constexpr double kPatience_s = 10;  // for a light that does not go out at all
constexpr double kRenewed_s = 0.5;
constexpr int kLeds = 10;

void sleep_s(double seconds) {
  std::this_thread::sleep_for(Seconds(seconds));
}

class Desk {
 public:
  explicit Desk(const StudyOptions& options) : options_(options) {}

  Result<void> start() { return rig_.start(options_.programs, options_.scenes / "satin.toml", 0.05); }

  // Seconds from the death to dark.
  Result<double> trial(bool daemon_dies, int led, double after_s) {
    if (Result<void> ok = rig_.serve(); !ok) return std::move(ok).error();
    if (auto opened = rig_.client().post("/api/v1/rig/devices", {{"open", true}}); !opened)
      return std::move(opened).error();
    const int renewals = 1 + static_cast<int>(after_s / kRenewed_s);
    for (int i = 0; i < renewals; ++i) {
      if (i > 0) sleep_s(kRenewed_s);
      auto lit = rig_.client().post("/api/v1/rig/light", {{"leds", {led}}});
      if (!lit) return std::move(lit).error();
      if ((*lit)["rest_s"] > 0) {
        sleep_s((*lit)["rest_s"].get<double>());
        i = -1;
      }
    }
    sleep_s(after_s - kRenewed_s * (renewals - 1));
    if (daemon_dies) rig_.kill_daemon();
    return seconds_to_dark(led);
  }

 private:
  Result<double> seconds_to_dark(int led) {
    const auto died = Clock::now();
    for (bool was_lit = false;; was_lit = true) {
      const Result<std::string> status = rig_.rig().say("status");
      if (!status) return status.error();
      const Json pins = Json::parse(*status)["pins"];
      const double passed_s = Seconds(Clock::now() - died).count();
      if (pins.empty() && !was_lit) {
        return Error{ErrorKind::kProtocol, fmt::format("LED {} was not lit", led), "lease", "",
                     "mend that first"};
      }
      if (pins.empty() || passed_s > kPatience_s) return passed_s;
      sleep_s(0.005);
    }
  }

  const StudyOptions& options_;
  ServedRig rig_;
};

}  // namespace

/// How long a LED stays lit once nobody holds it, told by the pins of a virtual board. A client lights a LED
/// through weft serve, renews it every half second, and at a random moment falls silent, or the daemon is
/// killed (SIGKILL). A row a death: "death" (client, daemon), "trials", "median_s", "worst_s", "late" (trials
/// that were not dark after 2 s). Errors: of the rig's and the daemon's start, and of a light that is
/// refused.
Result<Rows> server_lease_table(const StudyOptions& options) {
  Desk desk(options);
  if (Result<void> ok = desk.start(); !ok) return std::move(ok).error();
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> moment(0.05, 1.4);
  Rows rows;
  for (const bool daemon_dies : {false, true}) {
    std::vector<double> seconds;
    for (int i = 0; i < options.runs; ++i) {
      Result<double> dark = desk.trial(daemon_dies, 1 + i % kLeds, moment(random));
      if (!dark) return std::move(dark).error();
      seconds.push_back(*dark);
      options.progress(i + 1 + (daemon_dies ? options.runs : 0), 2 * options.runs);
    }
    rows.push_back({{"death", daemon_dies ? "daemon" : "client"},
                    {"trials", options.runs},
                    {"median_s", median(seconds)},
                    {"worst_s", *std::ranges::max_element(seconds)},
                    {"late", std::ranges::count_if(seconds, [](double s) { return s > kDark_s; })}});
  }
  return rows;
}

}  // namespace weft::bench
