// SPDX-License-Identifier: Apache-2.0
#include "bench/server/lease.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/server/http/client.h"
#include "core/process.h"
#include "core/statistics.h"
#include "core/temporary_folder.h"
#include "virtual_rig/rig_process.h"

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
  explicit Desk(const ServerLeaseOptions& options) : options_(options) {}

  Result<void> start() {
    auto rig = virtual_rig::RigProcess::start({.programs = options_.programs,
                                               .scene = options_.scene,
                                               .folder = folder_.path() / "rig",
                                               .megapixels = 0.05});
    if (!rig) return std::move(rig).error();
    rig_ = std::move(*rig);
    return {};
  }

  // Seconds from the death to dark.
  Result<double> trial(bool daemon_dies, int led, double after_s) {
    if (Result<void> ok = serve(); !ok) return std::move(ok).error();
    if (auto opened = client_->post("/api/v1/rig/devices", {{"open", true}}); !opened)
      return std::move(opened).error();
    const int renewals = 1 + static_cast<int>(after_s / kRenewed_s);
    for (int i = 0; i < renewals; ++i) {
      if (i > 0) sleep_s(kRenewed_s);
      auto lit = client_->post("/api/v1/rig/light", {{"leds", {led}}});
      if (!lit) return std::move(lit).error();
      if ((*lit)["rest_s"] > 0) {
        sleep_s((*lit)["rest_s"].get<double>());
        i = -1;
      }
    }
    sleep_s(after_s - kRenewed_s * (renewals - 1));
    if (daemon_dies) {
      daemon_->signal(SIGKILL);
      daemon_.reset();
    }
    return seconds_to_dark(led);
  }

 private:
  Result<void> serve() {
    if (daemon_) return {};
    auto daemon = rig_->weft({"serve"}, "serve.log");
    if (!daemon) return std::move(daemon).error();
    daemon_ = std::move(*daemon);
    const auto deadline = Clock::now() + Seconds(kPatience_s);
    for (;;) {
      const std::string said = daemon_->said();
      const std::size_t begin = said.rfind("\nhttp://");
      if (begin != std::string::npos && said.find('\n', begin + 1) != std::string::npos) {
        auto client = app::RigClient::connect(said.substr(begin + 1, said.find('\n', begin + 1) - begin - 1));
        if (!client) return std::move(client).error();
        client_ = std::move(*client);
        return {};
      }
      if (daemon_->wait(0.02) || Clock::now() > deadline) {
        return Error{ErrorKind::kTryAgain, "weft serve does not start", folder_.path().string(), said,
                     "mend that first"};
      }
    }
  }

  Result<double> seconds_to_dark(int led) {
    const auto died = Clock::now();
    for (bool was_lit = false;; was_lit = true) {
      const Result<std::string> status = rig_->say("status");
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

  const ServerLeaseOptions& options_;
  TemporaryFolder folder_;
  std::unique_ptr<virtual_rig::RigProcess> rig_;
  std::unique_ptr<ChildProcess> daemon_;
  std::optional<app::RigClient> client_;
};

}  // namespace

Result<Rows> server_lease_table(const ServerLeaseOptions& options) {
  Desk desk(options);
  if (Result<void> ok = desk.start(); !ok) return std::move(ok).error();
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> moment(0.05, 1.4);
  Rows rows;
  for (const bool daemon_dies : {false, true}) {
    std::vector<double> seconds;
    for (int i = 0; i < options.trials; ++i) {
      Result<double> dark = desk.trial(daemon_dies, 1 + i % kLeds, moment(random));
      if (!dark) return std::move(dark).error();
      seconds.push_back(*dark);
      options.progress(i + 1 + (daemon_dies ? options.trials : 0), 2 * options.trials);
    }
    rows.push_back({{"death", daemon_dies ? "daemon" : "client"},
                    {"trials", options.trials},
                    {"median_s", median(seconds)},
                    {"worst_s", *std::ranges::max_element(seconds)},
                    {"late", std::ranges::count_if(seconds, [](double s) { return s > kDark_s; })}});
  }
  return rows;
}

}  // namespace weft::bench
