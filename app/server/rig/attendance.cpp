// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/attendance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
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
constexpr double kMostLit_s = 40;  // of a LED at once, by its board
constexpr auto kLook = std::chrono::milliseconds(100);

Error is_closed(const std::string& rig) {
  return {ErrorKind::kTryAgain, "the devices are closed", rig, "nobody attends the rig",
          "open them (POST rig/devices)"};
}

Error is_scanning(const std::string& rig) {
  return {ErrorKind::kTryAgain, "a scan has the devices", rig, "", "wait for its end, or cancel it"};
}

bool may_pass(const Error& error) {
  return error.kind == ErrorKind::kTryAgain || error.kind == ErrorKind::kProtocol;
}

Calibration calibration_of(const capture::Rig& rig) {
  const fs::path folder = capture::calibration_now(rig);
  Result<Calibration> calibration = folder.empty() ? Calibration() : read_calibration(folder);
  return calibration ? std::move(*calibration) : Calibration();
}

std::optional<capture::PhotositeNoise> noise_of(const Calibration& calibration) {
  if (!calibration.response) return std::nullopt;
  return capture::PhotositeNoise{calibration.response->electrons_per_count,
                                 calibration.response->read_noise_counts};
}

/// Those of all LEDs of the rig.
std::optional<capture::PatchLights> lights_of(const Calibration& calibration, const capture::Rig& rig) {
  if (!calibration.camera || !calibration.lights) return std::nullopt;
  Result<capture::PatchLights> lights = capture::PatchLights::make(calibration, rig.scan.cloth_height_mm);
  if (!lights || lights->leds.size() < static_cast<std::size_t>(rig.leds)) return std::nullopt;
  return std::move(*lights);
}

/// Whether two photographs that cannot be metered by are of the same cloth, as far as they tell.
bool are_alike(const capture::Brightness& a, const capture::Brightness& b) {
  constexpr double kAlike = 0.1;
  return std::abs(a.bright - b.bright) <= kAlike * b.bright &&
         std::abs(a.clipped - b.clipped) <= kAlike * std::max(b.clipped, 0.001);
}

}  // namespace

Attendance::Attendance(capture::Rig rig, capture::OpenDevices open, fs::path folder, const Screens& screens,
                       Told told)
    : rig_(std::move(rig)),
      open_(std::move(open)),
      folder_(std::move(folder)),
      screens_(screens),
      told_(std::move(told)) {
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
  devices_ = std::move(*devices);
  set_.reset();
  const Calibration calibration = calibration_of(rig_);
  noise_ = noise_of(calibration);
  lights_ = lights_of(calibration, rig_);
  feel_heat_held();
  change([&](Status& status) { status.camera = std::move(*facts); });
  return {};
}

Result<void> Attendance::close() {
  const std::lock_guard devices(devices_mutex_);
  Result<void> dark;
  if (devices_) {
    if (const Result<double> off = devices_->lamps->light({}, 1); !off) dark = off.error();
  }
  devices_.reset();
  change([&](Status& status) {
    status.is_open = status.is_live = false;
    status.lit.clear();
    open_until_ = {};
  });
  return dark;
}

// A device does not do what it should: closed, and why.
void Attendance::fail_held(const Error& error) {
  devices_.reset();
  change([&](Status& status) {
    status.is_open = false;
    status.lit.clear();
    status.is_live = false;
    status.error = error;
    open_until_ = {};
  });
}

Result<double> Attendance::light_held(const std::vector<int>& leds, double most_s) {
  Result<double> rest = devices_->lamps->light(leds, most_s);
  if (!rest && may_pass(rest.error())) {
    if (Result<void> back = devices_->lamps->recover(); !back) {
      rest = std::move(back).error();
    } else {
      rest = devices_->lamps->light(leds, most_s);
    }
  }
  if (!rest && rest.error().kind != ErrorKind::kUsage) fail_held(rest.error());
  if (rest) feel_heat_held();
  return rest;
}

/// What cannot be told is not shown.
void Attendance::feel_heat_held() {
  Result<std::vector<double>> seconds = devices_->lamps->can_light_s();
  const std::lock_guard lock(mutex_);
  can_light_s_ = seconds ? std::move(*seconds) : std::vector<double>();
  felt_ = Clock::now();
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
  const std::vector<double> seconds = status().can_light_s;
  int led = 0;
  {
    const std::lock_guard lock(mutex_);
    const auto can = [&](int each) {
      const auto i = static_cast<std::size_t>(each) - 1;
      return i < seconds.size() ? seconds[i] : 0;
    };
    const Clock::time_point now = Clock::now();
    const bool goes_on = turn_ > 0 && now < turn_began_ + kTurn && can(turn_) > kLight_s;
    if (!goes_on) {
      // From the one that follows, so that those that are as cool as each other go round.
      int next = turn_ % rig_.leds + 1;
      for (int i = 1; i < rig_.leds; ++i) {
        const int other = (turn_ + i) % rig_.leds + 1;
        if (other != turn_ && can(other) > can(next)) next = other;
      }
      turn_ = next;
      turn_began_ = now;
    }
    led = turn_;
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
  Result<std::string> jpeg = devices_->camera->look();
  if (!jpeg) {
    const Error error = jpeg.error();
    if (const Result<capture::CameraFacts> back = devices_->camera->recover(); !back) fail_held(back.error());
    change([](Status& status) { status.is_live = false; });
    return error;
  }
  look_ = {look_.number + 1, std::move(*jpeg)};
  if (!status().is_live) change([](Status& status) { status.is_live = true; });
  return look_;
}

void Attendance::end_look_held() {
  if (devices_) static_cast<void>(devices_->camera->stop_looking());
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
  TestShot shot;
  shot.id = ++newest_;
  shot.led = led;
  shot.exposure_us = *exposure_us;
  shots_.push_back(shot);
  last = std::move(shooter_);
  shooter_ = std::jthread([this, shot = std::move(shot)] { take(shot); });
  return newest_;
}

void Attendance::take(TestShot shot) {
  change([this](Status& status) {
    status.doing = "shooting";
    status.is_dark = screens_.go_black();
  });
  screens_.wait_until_black();
  {
    const std::lock_guard devices(devices_mutex_);
    Result<FrameFile> frame =
        devices_ ? photograph_held(shot.led, shot.exposure_us, fmt::format("shot{:06}", shot.id))
                 : Result<FrameFile>(is_closed(rig_.name));
    if (frame) {
      shot.frame = std::move(*frame);
      look_at_held(shot);
    } else {
      shot.error = std::move(frame).error();
    }
    std::vector<int> again;
    double left_s = 0;
    {
      const std::lock_guard lock(mutex_);
      left_s = std::chrono::duration<double>(lit_until_ - Clock::now()).count();
      if (left_s > 0) again = wanted_;
    }
    if (devices_ && !again.empty()) {
      if (const Result<double> rest = light_held(again, left_s); !rest || *rest > 0) again.clear();
    }
    change([&](Status& status) {
      status.doing.clear();
      status.is_dark = false;
      status.lit = again;
    });
  }
  keep(shot);
  told_.shot(shot);
}

Result<FrameFile> Attendance::photograph_held(int led, double exposure_us, const std::string& stem) {
  if (status().is_live) end_look_held();
  if (Result<void> made = make_writable_folder(folder_); !made) return std::move(made).error();
  const capture::ExposureSettings exposure = {exposure_us, rig_.scan.iso, rig_.scan.f_number};
  if (set_ != exposure) {
    set_.reset();
    if (const Result<capture::CameraFacts> set = devices_->camera->set(exposure); !set) {
      if (set.error().kind == ErrorKind::kNoDevice) fail_held(set.error());
      return set.error();
    }
    set_ = exposure;
  }
  const double most_s = capture::ScanOptions().lamp_margin_s + 1e-6 * exposure_us;
  const std::vector<int> leds = led > 0 ? std::vector{led} : std::vector<int>();
  const Result<double> rest = light_held(leds, most_s);
  if (!rest) return rest.error();
  if (*rest > 0) {
    return Error{ErrorKind::kTryAgain, fmt::format("LED {} is too warm", led), rig_.name,
                 fmt::format("it has to rest for {:.0f} s", *rest), "take the shot after that"};
  }
  change([&](Status& status) { status.lit = leds; });
  Result<capture::Photograph> photograph =
      devices_->camera->take(folder_ / stem, [&] { static_cast<void>(devices_->lamps->light({}, 1)); });
  if (photograph) return FrameFile{photograph->file, photograph->sha256, {}};
  static_cast<void>(devices_->lamps->light({}, 1));
  set_.reset();
  if (const Result<capture::CameraFacts> back = devices_->camera->recover(); !back) fail_held(back.error());
  return std::move(photograph).error();
}

/// Of one that cannot be decoded nothing is told here: its histogram says why.
void Attendance::look_at_held(TestShot& shot) {
  const Result<RawFrame> frame = capture::decode_raw(shot.frame->file);
  if (!frame) return;
  shot.size = frame->counts.size();
  if (shot.led != series_led_ || shot.exposure_us != series_us_) {
    series_ = {};
    metered_.reset();
  }
  series_led_ = shot.led;
  series_us_ = shot.exposure_us;
  shot.focus = series_.add(capture::focus_of(*frame, noise_));
  if (shot.led > 0)
    shot.suggested_us = suggested_held({shot.led, shot.exposure_us, capture::brightness_of(*frame)});
}

/// What a scan of this cloth would be exposed with; none where its meter fails.
std::optional<double> Attendance::suggested_held(const capture::MeteredShot& shot) {
  std::vector<int> leds(static_cast<std::size_t>(rig_.leds));
  std::iota(leds.begin(), leds.end(), 1);
  const capture::MeterInput input =
      capture::meter_input(std::move(leds), status().exposures_us, lights_, rig_.scan.iso);
  if (const std::optional<double> read_us = capture::metered_by(shot, input)) return read_us;
  if (metered_ && are_alike(shot.seen, metered_->seen)) return metered_->exposure_us;
  const Result<capture::Metering> metering =
      capture::meter(input, [&](int led, double exposure_us) -> Result<capture::Brightness> {
        if (!devices_ || is_wanted()) return is_closed(rig_.name);
        const Result<FrameFile> photograph = photograph_held(led, exposure_us, "meter");
        if (!photograph) return photograph.error();
        const Result<RawFrame> frame = capture::decode_raw(photograph->file);
        std::error_code ignored;
        fs::remove(photograph->file, ignored);
        return frame ? Result<capture::Brightness>(capture::brightness_of(*frame)) : frame.error();
      });
  if (!metering) return std::nullopt;
  metered_ = {shot.seen, metering->exposure_us};
  return metering->exposure_us;
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
    shots_.back() = std::move(shot);
    for (; shots_.size() > kKeptShots; shots_.pop_front()) {
      if (shots_.front().frame) gone.push_back(shots_.front().frame->file);
    }
  }
  std::error_code ignored;
  for (const fs::path& file : gone) fs::remove(file, ignored);
}

Result<TestShot> Attendance::shot(int id) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(shots_, id, &TestShot::id);
  if (found != shots_.end()) return *found;
  return Error{ErrorKind::kNoInput, "no such test shot", std::to_string(id),
               fmt::format("the last {} are kept", kKeptShots), "take another one"};
}

Attendance::Status Attendance::status() const {
  const std::lock_guard lock(mutex_);
  Status status = status_;
  if (!status.is_open) return status;
  // What was lit since heats it, what was dark cools it, a second a second.
  const double since_s = std::chrono::duration<double>(Clock::now() - felt_).count();
  for (std::size_t i = 0; i < can_light_s_.size(); ++i) {
    const bool is_lit = std::ranges::count(status.lit, static_cast<int>(i) + 1) > 0;
    status.can_light_s.push_back(
        std::clamp(can_light_s_[i] + (is_lit ? -since_s : since_s), 0.0, kMostLit_s));
  }
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
      devices_ ? Result<capture::RigDevices>(std::move(*devices_)) : open_(rig_);
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
    if (status_.is_open) devices_ = std::move(devices);
    set_.reset();
  }
  {
    const std::lock_guard held(devices_mutex_);
    if (devices_) feel_heat_held();
  }
  told_.changed();
}

// Ends leases.
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

namespace {

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json to_json(const capture::FocusStanding& focus) {
  Json scores = Json::array(), cells = Json::array();
  for (const double score : focus.scores) scores.push_back(number_or_null(score));
  for (const double cell : focus.relative) cells.push_back(number_or_null(cell));
  return {{"scores", std::move(scores)},
          {"best", focus.best},
          {"columns", capture::FocusMap::kColumns},
          {"relative", std::move(cells)},
          {"more_right", focus.more_right ? Json(*focus.more_right) : Json()},
          {"more_below", focus.more_below ? Json(*focus.more_below) : Json()}};
}

}  // namespace

Json document_of(const TestShot& shot, FramePictures& pictures) {
  Json document = {{"id", shot.id},
                   {"led", shot.led},
                   {"exposure_us", shot.exposure_us},
                   {"state", shot.error   ? "failed"
                             : shot.frame ? "taken"
                                          : "taking"},
                   {"width", shot.size.width},
                   {"height", shot.size.height},
                   {"suggested_us", shot.suggested_us ? Json(*shot.suggested_us) : Json()},
                   {"clipped_rgb", Json()},
                   {"histogram", Json()},
                   {"focus", shot.focus ? to_json(*shot.focus) : Json()},
                   {"error", shot.error ? json_of(*shot.error) : Json()}};
  if (!shot.frame) return document;
  const Result<Json> histogram = pictures.histogram(*shot.frame);
  if (!histogram) {
    document["error"] = json_of(histogram.error());
    return document;
  }
  document["histogram"] = *histogram;
  document["clipped_rgb"] = {(*histogram)["red"]["clipped"], (*histogram)["green"]["clipped"],
                             (*histogram)["blue"]["clipped"]};
  return document;
}

Json to_json(const Attendance::Status& status) {
  return {{"open", status.is_open},
          {"doing", status.doing},
          {"lit", status.lit},
          {"live", status.is_live},
          {"error", status.error ? json_of(*status.error) : Json()}};
}

}  // namespace weft::app
