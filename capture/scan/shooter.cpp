// SPDX-License-Identifier: Apache-2.0
#include "capture/scan/shooter.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <utility>

namespace weft::capture {
namespace {

using std::chrono::steady_clock;

constexpr auto kPause = std::chrono::milliseconds(20);
constexpr auto kBetweenSearches = std::chrono::milliseconds(500);

bool may_pass(ErrorKind kind) {
  return kind == ErrorKind::kTryAgain || kind == ErrorKind::kProtocol || kind == ErrorKind::kNoDevice;
}

Error light_went_out(int led, std::chrono::duration<double> after) {
  return {ErrorKind::kTryAgain, "a light went out before the shutter closed", "LED " + std::to_string(led),
          "the camera took over " + std::to_string(std::lround(after.count())) + " s for the shot",
          "take the shot again; if it happens often look at the camera's settings"};
}

}  // namespace

void Report::change(const std::function<void(ScanStatus&)>& change) {
  const std::lock_guard lock(mutex_);
  change(status_);
  events_.status(status_);
}

void Report::phase(ScanPhase phase, std::string why) {
  change([&](ScanStatus& status) {
    if (status.phase == ScanPhase::kMetering) status.led = 0;  // its test shots are no LED's photograph
    status.phase = phase;
    status.why = std::move(why);
  });
}

void Report::kept(const KeptFrame& frame) {
  const std::lock_guard lock(mutex_);
  ++status_.frames;
  events_.kept(frame);
  events_.status(status_);
}

void Report::refused(const RefusedFrame& frame) {
  const std::lock_guard lock(mutex_);
  events_.refused(frame);
}

ScanPhase Report::phase() const {
  const std::lock_guard lock(mutex_);
  return status_.phase;
}

Error cancelled(const std::string& where) {
  return {ErrorKind::kInterrupted, "scan was stopped", where, "on request",
          "run the same command again to go on"};
}

Result<void> Shooter::wait_for(const std::function<Result<void>()>& find) {
  const auto until = steady_clock::now() + std::chrono::duration<double>(options_.device_patience_s);
  for (;;) {
    Result<void> found = find();
    if (found || !may_pass(found.error().kind)) return found;
    report_.phase(ScanPhase::kRecovering, found.error().message());
    if (steady_clock::now() >= until) return found;
    const auto next = std::min<steady_clock::time_point>(
        steady_clock::now() + kBetweenSearches, std::chrono::time_point_cast<steady_clock::duration>(until));
    while (steady_clock::now() < next) {
      if (is_cancelled()) return cancelled("devices");
      std::this_thread::sleep_for(kPause);
    }
  }
}

Result<CameraFacts> Shooter::connect() {
  report_.phase(ScanPhase::kConnecting);
  bool is_first = true;
  CameraFacts facts;
  Result<void> found = wait_for([&]() -> Result<void> {
    Result<CameraFacts> says = std::exchange(is_first, false) ? camera_.connect() : camera_.recover();
    if (!says) return says.error();
    facts = std::move(*says);
    return {};
  });
  if (!found) return found.error();
  found = wait_for([&]() -> Result<void> {
    if (Result<void> off = lamps_off(); off) return off;
    return lamps_.recover();
  });
  if (!found) return found.error();
  lamps_failed_ = false;
  turned_.reset();
  return facts;
}

Result<std::vector<double>> Shooter::shutter_times_us() {
  Result<std::vector<double>> times = camera_.shutter_times_us();
  for (int i = 1; !times && may_pass(times.error().kind) && i < options_.tries_per_shot; ++i) {
    if (Result<void> again = recover(times.error()); !again) return again.error();
    times = camera_.shutter_times_us();
  }
  return times;
}

Result<void> Shooter::wait_while_paused(const std::string& why) {
  if (!is_paused()) return {};
  report_.phase(ScanPhase::kPaused, why);
  while (is_paused()) {
    if (is_cancelled()) return cancelled("scan");
    std::this_thread::sleep_for(kPause);
  }
  return {};
}

Result<void> Shooter::wait_for_blade(int led) {
  report_.change([&](ScanStatus& status) {
    status.led = led;
    status.role = ShotRole::kBlade;
  });
  if (control_.wait_for_person) control_.wait_for_person();
  return wait_while_paused(fmt::format(
      "lay a straight opaque edge, as a steel rule, some millimetres above the cloth, so that the "
      "edge of its shadow under LED {} crosses the middle of the picture beside it; then resume",
      led));
}

Result<void> Shooter::recover(const Error& error) {
  report_.phase(ScanPhase::kRecovering, error.message());
  set_.reset();
  (void)lamps_off();
  if (lamps_failed_) {
    Result<void> back = wait_for([&] { return lamps_.recover(); });
    if (!back) return back;
    lamps_failed_ = false;
    turned_.reset();
  }
  count_.connected();
  return wait_for([&]() -> Result<void> {
    const Result<CameraFacts> facts = camera_.recover();
    return facts ? Result<void>() : facts.error();
  });
}

Result<void> Shooter::lamps_off() {
  const Result<double> off = lamps_.light({}, 1);
  if (off) return {};
  lamps_failed_ = true;
  return off.error();
}

Result<void> Shooter::let_cool(int led, double cools_s) {
  const ScanPhase before = report_.phase();
  const auto whole_s = static_cast<int>(std::ceil(cools_s));
  report_.phase(ScanPhase::kCooling,
                "LED " + std::to_string(led) + " cools, " + std::to_string(whole_s) + " s");
  const auto until = steady_clock::now() + std::chrono::duration<double>(cools_s);
  while (steady_clock::now() < until && !is_paused()) {
    if (is_cancelled()) return cancelled("scan");
    std::this_thread::sleep_for(kPause);
  }
  if (Result<void> go = wait_while_paused(); !go) return go;
  report_.phase(before);
  return {};
}

Result<steady_clock::time_point> Shooter::light(const std::vector<int>& leds,
                                                std::chrono::duration<double> most_lit) {
  for (;;) {  // ends: a LED that is dark cools
    if (is_cancelled()) return cancelled("scan");
    const auto asked = steady_clock::now();
    const Result<double> cools_s = lamps_.light(leds, most_lit.count());
    if (!cools_s) {
      lamps_failed_ = true;
      return cools_s.error();
    }
    if (*cools_s <= 0) return std::chrono::time_point_cast<steady_clock::duration>(asked + most_lit);
    if (Result<void> cool = let_cool(leds.front(), *cools_s); !cool) return cool.error();
  }
}

Result<void> Shooter::turn(Polariser state) {
  if (!use_.is_turned || turned_ == state) return {};
  const Result<void> turned = lamps_.polarise(state);
  if (!turned) {
    lamps_failed_ = true;
    return turned;
  }
  const auto stands = steady_clock::now() + std::chrono::duration<double>(use_.settle_s);
  while (steady_clock::now() < stands) {
    if (is_cancelled()) return cancelled("scan");
    std::this_thread::sleep_for(kPause);
  }
  turned_ = state;
  return {};
}

Result<Photograph> Shooter::take_once(const ShotLight& wanted, const ExposureSettings& exposure,
                                      const std::filesystem::path& file, bool is_metering) {
  if (set_ != exposure) {
    const Result<CameraFacts> set = camera_.set(exposure);
    if (!set) return set.error();
    set_ = exposure;
  }
  report_.change([&](ScanStatus& status) {
    status.led = wanted.led;
    status.role = wanted.role;
    status.polariser = wanted.polariser;
    status.why.clear();
    status.phase = is_metering ? ScanPhase::kMetering : ScanPhase::kExposing;
  });
  if (Result<void> stands = turn(wanted.polariser); !stands) return stands.error();
  const int led = wanted.role == ShotRole::kBelow ? lamps_.leds() + 1 : wanted.led;
  const std::chrono::duration<double> most_lit(options_.lamp_margin_s + exposure.exposure_us * 1e-6);
  std::vector<int> leds;
  if (led != 0) leds.push_back(led);
  if (wanted.second != 0) leds.push_back(wanted.second);
  const auto goes_out = light(leds, most_lit);
  if (!goes_out) return goes_out.error();
  Result<void> off;
  bool is_exposed = false;
  Result<Photograph> photograph = camera_.take(file, [&] {
    is_exposed = true;
    const bool went_out = led != 0 && steady_clock::now() >= *goes_out;
    off = lamps_off();
    if (off && went_out) off = light_went_out(led, most_lit);
    if (!is_metering) report_.change([](ScanStatus& status) { status.phase = ScanPhase::kFetching; });
  });
  if (!is_exposed) off = lamps_off();
  if (!photograph) return photograph;
  // Asked first: a photograph that is not used counts all the same.
  if (Result<void> ours = count_.check(*photograph); !ours) return ours.error();
  if (!off) return off.error();
  return photograph;
}

Result<Photograph> Shooter::take(const ShotLight& light, const ExposureSettings& exposure,
                                 const std::filesystem::path& file, const std::function<void()>& clear) {
  const bool is_metering = report_.phase() == ScanPhase::kMetering;
  if (light.role == ShotRole::kBlade) {
    if (Result<void> laid = wait_for_blade(light.led); !laid) return laid.error();
  }
  for (int i = 1;; ++i) {
    if (Result<void> go = wait_while_paused(); !go) return go.error();
    if (is_cancelled()) return cancelled("scan");
    Result<Photograph> photograph = take_once(light, exposure, file, is_metering);
    if (photograph) {
      long_waits_.note(*photograph);
      return photograph;
    }
    count_.failed();
    if (!may_pass(photograph.error().kind) || i >= options_.tries_per_shot) {
      (void)lamps_off();
      return photograph;
    }
    ++retaken_;
    if (Result<void> again = recover(photograph.error()); !again) return again.error();
    clear();
  }
}

}  // namespace weft::capture
