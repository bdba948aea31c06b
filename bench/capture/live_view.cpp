// SPDX-License-Identifier: Apache-2.0
#include "bench/capture/live_view.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/statistics.h"
#include "core/temporary_folder.h"

namespace weft::bench {
namespace {

using std::chrono::steady_clock;

constexpr double kAskedFirst_s = 1.5, kAskedRate = 10;

double since_s(steady_clock::time_point began) {
  return std::chrono::duration<double>(steady_clock::now() - began).count();
}

class Finder {
 public:
  Finder(const LiveViewOptions& options, capture::RigDevices devices)
      : options_(options), devices_(std::move(devices)) {}

  Result<Rows> table() {
    if (const auto facts = devices_.camera->connect(); !facts) return facts.error();
    for (int round = 0; round < options_.rounds; ++round) {
      if (Result<void> ok = look(); !ok) return ok.error();
      if (Result<void> ok = photograph(after_live_s_); !ok) return ok.error();
      if (Result<void> ok = photograph(plain_s_); !ok) return ok.error();
    }
    return Rows{{{"what", "first picture, s"}, {"reached", worst_first_s_}, {"asked", kAskedFirst_s}},
                {{"what", "pictures a second"}, {"reached", pictures_ / looked_s_}, {"asked", kAskedRate}},
                {{"what", "photograph after live view, s"}, {"reached", median(after_live_s_)}},
                {{"what", "photograph, s"}, {"reached", median(plain_s_)}}};
  }

 private:
  Result<void> look() {
    const auto asked = steady_clock::now();
    if (const auto first = devices_.camera->look(); !first) return first.error();
    worst_first_s_ = std::max(worst_first_s_, since_s(asked));
    const auto began = steady_clock::now();
    for (; since_s(began) < options_.looks_s; ++pictures_) {
      if (const auto picture = devices_.camera->look(); !picture) return picture.error();
    }
    looked_s_ += since_s(began);
    return {};
  }

  Result<void> photograph(std::vector<double>& seconds) {
    const auto began = steady_clock::now();
    if (const auto set = devices_.camera->set({options_.exposure_us, 100, 8}); !set) return set.error();
    const auto taken = devices_.camera->take(scratch_.path() / "shot", [] {});
    if (!taken) return taken.error();
    seconds.push_back(since_s(began));
    std::error_code ignored;
    std::filesystem::remove(taken->file, ignored);
    return {};
  }

  const LiveViewOptions& options_;
  capture::RigDevices devices_;
  const TemporaryFolder scratch_;
  double worst_first_s_ = 0, pictures_ = 0, looked_s_ = 0;
  std::vector<double> after_live_s_, plain_s_;
};

}  // namespace

Result<Rows> capture_live_view_table(const LiveViewOptions& options) {
  Result<capture::RigDevices> devices = options.open(options.rig);
  if (!devices) return std::move(devices).error();
  return Finder(options, std::move(*devices)).table();
}

}  // namespace weft::bench
