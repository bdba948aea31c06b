// SPDX-License-Identifier: Apache-2.0
#include "app/cli/opened_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "app/cli/terminal.h"
#include "app/server/rig/rig_lock.h"
#include "core/describe/error_json.h"

namespace weft::app {

bool wait_for(double seconds, const std::stop_token& stop) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < until && !stop.stop_requested()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return !stop.stop_requested();
}

Result<std::unique_ptr<OpenedDevices>> OpenedDevices::open(const capture::Rig& rig) {
  const Result<std::optional<std::string>> owner = address_of_owner(rig);
  if (!owner) return owner.error();
  Result<ReachedRig> reached = reach_rig(rig, *owner);
  if (!reached) return std::move(reached).error();
  const Result<Json> before = reached->client.get("/api/v1/rig/devices");
  if (!before) return before.error();
  std::unique_ptr<OpenedDevices> devices(new OpenedDevices(std::move(*reached), before->at("open")));
  if (const Result<Json> opened = devices->client().post("/api/v1/rig/devices", {{"open", true}}); !opened)
    return opened.error();
  return devices;
}

OpenedDevices::~OpenedDevices() {
  static_cast<void>(were_open_ ? client().post("/api/v1/rig/light", {{"leds", Json::array()}})
                               : client().post("/api/v1/rig/devices", {{"open", false}}));
}

Result<double> OpenedDevices::hold(int led, double seconds, const std::stop_token& stop) const {
  constexpr double kRenewed_s = 0.5;
  for (double left_s = seconds; left_s > 0; left_s -= kRenewed_s) {
    const Result<Json> lit = client().post("/api/v1/rig/light", {{"leds", {led}}});
    if (!lit) return lit.error();
    if (const double rest_s = lit->at("rest_s"); rest_s > 0) return rest_s;
    if (!wait_for(std::min(left_s, kRenewed_s), stop)) return interrupted();
  }
  return 0.0;
}

Result<Json> OpenedDevices::shoot(int led, double exposure_us, const std::stop_token& stop) const {
  const Result<Json> asked =
      client().post("/api/v1/rig/test-shot", {{"led", led}, {"exposure_us", exposure_us}});
  if (!asked) return asked.error();
  const std::string path = fmt::format("/api/v1/rig/test-shots/{}", asked->at("id").get<int>());
  Result<Json> shot = client().get(path);
  for (; shot && shot->at("state") == "taking"; shot = client().get(path)) {
    if (!wait_for(0.1, stop)) return interrupted();
  }
  if (shot && shot->at("state") == "failed") return error_of_json(shot->at("error"), "test shot");
  return shot;
}

}  // namespace weft::app
