// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/attendance.h"

#include <fmt/format.h>

#include <utility>

#include "capture/raw/decode_raw.h"
#include "capture/scan/histogram.h"
#include "capture/scan/scan_plan.h"
#include "core/base/files.h"
#include "core/describe/error_json.h"
#include "core/rig/calibration.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr double kLight_s = 1e-3 * static_cast<double>(Attendance::kLightLease.count());
constexpr auto kLook = std::chrono::milliseconds(100);

Error is_closed(const std::string& rig) {
  return {ErrorKind::kTryAgain, "the devices are closed", rig, "nobody attends the rig",
          "open them (POST rig/devices)"};
}

Error is_scanning(const std::string& rig) {
  return {ErrorKind::kTryAgain, "a scan has the devices", rig, "", "wait for its end, or cancel it"};
}

Calibration calibration_of(const capture::Rig& rig) {
  const fs::path folder = capture::calibration_now(rig);
  Result<Calibration> calibration = folder.empty() ? Calibration() : read_calibration(folder);
  return calibration ? std::move(*calibration) : Calibration();
}

}  // namespace

Attendance::Attendance(capture::Rig rig, capture::OpenDevices open, fs::path folder, const Screens& screens,
                       Told told)
    : rig_(std::move(rig)),
      open_(std::move(open)),
      folder_(std::move(folder)),
      screens_(screens),
      told_(std::move(told)),
      reader_(rig_),
      turns_(rig_.leds) {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);  // shots of a daemon before this one
  watch_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

Attendance::~Attendance() {
  watch_.request_stop();
}

bool Attendance::stop(std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  is_stopping_ = true;
  if (!changed_.wait_for(lock, most, [&] { return !is_shooting_; })) return false;
  lock.unlock();
  static_cast<void>(close());
  return true;
}

template <typename Change>
void Attendance::change(const Change& change) {
  {
    const std::lock_guard lock(mutex_);
    change(status_);
  }
  told_.changed();
}

void Attendance::renew() {
  open_until_ = Clock::now() + kLease;
}

Result<void> Attendance::open() {
  {
    const std::lock_guard lock(mutex_);
    if (is_lent_) return is_scanning(rig_.name);
    renew();
    if (status_.is_open) return {};
    status_.doing = "opening";
  }
  told_.changed();
  const std::lock_guard devices(devices_mutex_);
  Result<void> opened = devices_ ? Result<void>() : open_held();
  change([&](Status& status) {
    status.doing.clear();
    status.is_open = opened.has_value();
    status.error = opened ? std::nullopt : std::optional(opened.error());
  });
  return opened;
}

Result<void> Attendance::open_held() {
  Result<capture::RigDevices> devices = open_(rig_);
  if (!devices) return std::move(devices).error();
  Result<capture::CameraFacts> facts = devices->camera->connect();
  if (!facts) return std::move(facts).error();
  if (Result<std::vector<double>> times = devices->camera->shutter_times_us(); times)
    know_exposures(std::move(*times));
  devices_.emplace(std::move(*devices));
  reader_.calibrate(calibration_of(rig_));
  feel_heat_held();
  change([&](Status& status) { status.camera = std::move(*facts); });
  return {};
}

Result<void> Attendance::close() {
  const std::lock_guard devices(devices_mutex_);
  Result<void> dark = devices_ ? devices_->go_dark() : Result<void>();
  devices_.reset();
  change([&](Status& status) {
    status.is_open = status.is_live = false;
    status.lit.clear();
    open_until_ = {};
  });
  return dark;
}

void Attendance::close_if_broken_held() {
  const std::optional<Error> why = devices_->broken();
  if (!why) return;
  devices_.reset();
  change([&](Status& status) {
    status.is_open = status.is_live = false;
    status.lit.clear();
    status.error = why;
    open_until_ = {};
  });
}

/// What cannot be told is not shown.
void Attendance::feel_heat_held() {
  Result<std::vector<double>> seconds = devices_->can_light_s();
  const std::lock_guard lock(mutex_);
  heat_ = {seconds ? std::move(*seconds) : std::vector<double>(), Clock::now()};
}

Result<double> Attendance::light_held(const std::vector<int>& leds, double most_s) {
  Result<double> rest = devices_->light(leds, most_s);
  close_if_broken_held();
  if (rest) feel_heat_held();
  return rest;
}

Result<Attendance::Lit> Attendance::light(const std::vector<int>& leds) {
  {
    const std::lock_guard lock(mutex_);
    if (is_lent_) return is_scanning(rig_.name);
    if (!status_.is_open) return is_closed(rig_.name);
    renew();
    wanted_ = leds;
    lit_until_ = Clock::now() + kLightLease;
    if (is_shooting_) return Lit{leds, 0};  // lit after the shot
  }
  const std::lock_guard devices(devices_mutex_);
  if (!devices_) return is_closed(rig_.name);
  Result<double> rest = light_held(leds, kLight_s);
  if (!rest) return std::move(rest).error();
  const std::vector<int> lit = *rest > 0 ? std::vector<int>() : leds;
  if (status().lit != lit) change([&](Status& status) { status.lit = lit; });
  return Lit{lit, *rest};
}

Result<Attendance::Lit> Attendance::light_in_turns() {
  const std::vector<double> can_light_s = status().can_light_s;
  int led = 0;
  {
    const std::lock_guard lock(mutex_);
    led = turns_.turn(can_light_s, kLight_s, Clock::now());
  }
  return light({led});
}

Result<Attendance::Look> Attendance::look(std::int64_t after) {
  {
    const std::lock_guard lock(mutex_);
    if (is_lent_) return is_scanning(rig_.name);
    if (!status_.is_open) return is_closed(rig_.name);
    renew();
    look_until_ = Clock::now() + kLookLease;
  }
  const std::lock_guard devices(devices_mutex_);
  if (!devices_) return is_closed(rig_.name);
  if (look_.number > after && status().is_live) return look_;
  Result<std::string> jpeg = devices_->look();
  if (!jpeg) {
    close_if_broken_held();
    change([](Status& status) { status.is_live = false; });
    return std::move(jpeg).error();
  }
  look_ = {look_.number + 1, std::move(*jpeg)};
  if (!status().is_live) change([](Status& status) { status.is_live = true; });
  return look_;
}

void Attendance::end_look_held() {
  if (devices_) devices_->stop_looking();
  change([](Status& status) { status.is_live = false; });
}

Result<double> Attendance::settable_us(double exposure_us) const {
  return capture::settable_time_us(status().exposures_us, exposure_us);
}

void Attendance::know_exposures(std::vector<double> exposures_us) {
  const std::lock_guard lock(mutex_);
  status_.exposures_us = std::move(exposures_us);
}

Result<int> Attendance::shoot(int led, double wanted_us) {
  const Result<double> exposure_us = settable_us(wanted_us);
  if (!exposure_us) return exposure_us.error();
  std::jthread last;  // may still tell of its shot: joined once nothing is locked
  const std::lock_guard lock(mutex_);
  if (is_lent_) return is_scanning(rig_.name);
  if (!status_.is_open || is_stopping_) return is_closed(rig_.name);
  if (is_shooting_) {
    return Error{ErrorKind::kTryAgain, "a test shot is being taken", rig_.name, "",
                 "wait for its event, or ask for it by its id"};
  }
  renew();
  is_shooting_ = true;
  TestShot shot = shots_.begin(led, *exposure_us);
  const int id = shot.id;
  last = std::move(shooter_);
  shooter_ = std::jthread([this, shot = std::move(shot)] { take(shot); });
  return id;
}

void Attendance::take(TestShot shot) {
  change([this](Status& status) {
    status.doing = "shooting";
    status.is_dark = screens_.go_black();
  });
  screens_.wait_until_black();
  {
    const std::lock_guard devices(devices_mutex_);
    photograph_and_read_held(shot);
    const std::vector<int> lit = light_again_held();
    change([&](Status& status) {
      status.doing.clear();
      status.is_dark = false;
      status.lit = lit;
    });
  }
  keep(shot);
  told_.shot(shot);
}

void Attendance::photograph_and_read_held(TestShot& shot) {
  Result<FrameFile> frame = devices_ ? photograph_held(shot.led, shot.exposure_us, stem_of_shot(shot.id))
                                     : Result<FrameFile>(is_closed(rig_.name));
  if (!frame) {
    shot.error = std::move(frame).error();
    return;
  }
  shot.frame = std::move(*frame);
  const Result<RawFrame> decoded = capture::decode_raw(shot.frame->file);
  if (!decoded) return;  // its histogram says why
  shot.reading =
      reader_.read(*decoded, shot.led, shot.exposure_us, status().exposures_us,
                   [this](int led, double exposure_us) { return meter_shot_held(led, exposure_us); });
}

Result<FrameFile> Attendance::photograph_held(int led, double exposure_us, const std::string& stem) {
  if (status().is_live) end_look_held();
  if (Result<void> made = make_writable_folder(folder_); !made) return std::move(made).error();
  const Result<void> set = devices_->set({exposure_us, rig_.scan.iso, rig_.scan.f_number});
  close_if_broken_held();
  if (!set) return set.error();
  const double most_s = capture::ScanOptions().lamp_margin_s + 1e-6 * exposure_us;
  const std::vector<int> leds = led > 0 ? std::vector{led} : std::vector<int>();
  const Result<double> rest = light_held(leds, most_s);
  if (!rest) return rest.error();
  if (*rest > 0) {
    return Error{ErrorKind::kTryAgain, fmt::format("LED {} is too warm", led), rig_.name,
                 fmt::format("it has to rest for {:.0f} s", *rest), "take the shot after that"};
  }
  change([&](Status& status) { status.lit = leds; });
  Result<capture::Photograph> photograph = devices_->take(folder_ / stem);
  close_if_broken_held();
  if (!photograph) return std::move(photograph).error();
  return FrameFile{photograph->file, photograph->sha256, {}};
}

Result<capture::Brightness> Attendance::meter_shot_held(int led, double exposure_us) {
  if (!devices_ || is_wanted()) return is_closed(rig_.name);
  const Result<FrameFile> photograph = photograph_held(led, exposure_us, "meter");
  if (!photograph) return photograph.error();
  const Result<RawFrame> frame = capture::decode_raw(photograph->file);
  std::error_code ignored;
  fs::remove(photograph->file, ignored);
  return frame ? Result<capture::Brightness>(capture::brightness_of(*frame)) : frame.error();
}

/// Those that the light's lease still asks for, as far as the board lights them.
std::vector<int> Attendance::light_again_held() {
  std::vector<int> leds;
  double left_s = 0;
  {
    const std::lock_guard lock(mutex_);
    left_s = std::chrono::duration<double>(lit_until_ - Clock::now()).count();
    if (left_s > 0) leds = wanted_;
  }
  if (!devices_ || leds.empty()) return leds;
  const Result<double> rest = light_held(leds, left_s);
  return rest && *rest == 0 ? leds : std::vector<int>();
}

bool Attendance::is_wanted() const {
  const std::lock_guard lock(mutex_);
  return is_lent_ || is_stopping_;
}

void Attendance::keep(TestShot shot) {
  std::vector<fs::path> gone;
  {
    const std::lock_guard lock(mutex_);
    is_shooting_ = false;
    changed_.notify_all();
    gone = shots_.end(std::move(shot));
  }
  std::error_code ignored;
  for (const fs::path& file : gone) fs::remove(file, ignored);
}

Result<TestShot> Attendance::shot(int id) const {
  const std::lock_guard lock(mutex_);
  return shots_.find(id);
}

Attendance::Status Attendance::status() const {
  const std::lock_guard lock(mutex_);
  Status status = status_;
  if (status.is_open) status.can_light_s = heat_.can_light_s(status.lit, Clock::now());
  return status;
}

Result<capture::RigDevices> Attendance::lend() {
  {
    const std::lock_guard lock(mutex_);
    is_lent_ = true;
  }
  const std::lock_guard devices(devices_mutex_);
  if (status().is_live) end_look_held();
  Result<capture::RigDevices> lent =
      devices_ ? Result<capture::RigDevices>(std::move(*devices_).release()) : open_(rig_);
  devices_.reset();
  const std::lock_guard lock(mutex_);
  is_lent_ = lent.has_value();
  status_.is_open = false;
  status_.lit.clear();
  status_.error.reset();
  if (lent) status_.doing = "scanning";
  return lent;
}

void Attendance::take_back(capture::RigDevices devices) {
  {
    const std::lock_guard held(devices_mutex_);
    const std::lock_guard lock(mutex_);
    is_lent_ = false;
    status_.doing.clear();
    status_.is_open = Clock::now() < open_until_;
    if (status_.is_open) devices_.emplace(std::move(devices));
  }
  {
    const std::lock_guard held(devices_mutex_);
    if (devices_) feel_heat_held();
  }
  told_.changed();
}

void Attendance::watch(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    changed_.wait_for(lock, stop, kLook, [] { return false; });
    const Clock::time_point now = Clock::now();
    const bool is_idle = !is_shooting_ && !stop.stop_requested();
    const bool went_dark = is_idle && !status_.lit.empty() && now >= lit_until_;
    const bool ran_out = is_idle && status_.is_open && now >= open_until_;
    const bool looked_away = is_idle && status_.is_live && now >= look_until_;
    if (!went_dark && !ran_out && !looked_away) continue;
    if (went_dark) status_.lit.clear();
    lock.unlock();
    if (looked_away) {
      const std::lock_guard devices(devices_mutex_);
      end_look_held();
    }
    if (ran_out) {
      static_cast<void>(close());
    } else {
      told_.changed();
    }
    lock.lock();
  }
}

Json to_json(const Attendance::Status& status) {
  return {{"open", status.is_open},
          {"doing", status.doing},
          {"lit", status.lit},
          {"live", status.is_live},
          {"error", status.error ? json_of(*status.error) : Json()}};
}

}  // namespace weft::app
