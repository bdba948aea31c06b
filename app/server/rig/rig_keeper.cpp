// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/rig_keeper.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "app/server/http/error_reply.h"
#include "app/server/rig/watched_camera.h"
#include "core/describe/error_json.h"
#include "core/rig/session.h"
#include "library/catalogue/session_files.h"

namespace weft::app {
namespace {

constexpr auto kBetweenSearches = std::chrono::milliseconds(500);

std::string name_of_session(const capture::ScanRequest& request) {
  return request.session.stem().string();
}

Error nothing_runs(const std::string& rig, const char* remedy) {
  return {ErrorKind::kTryAgain, "no scan is running", rig, "", remedy};
}

/// Devices that go back however a scan ends.
struct Lent {
  Attendance& to;
  mutable capture::RigDevices devices;
  ~Lent() { to.take_back(std::move(devices)); }
};

/// Whether the table is photographed, and must get no light but that of a LED.
bool exposes(capture::ScanPhase phase) {
  using capture::ScanPhase;
  return phase == ScanPhase::kMetering || phase == ScanPhase::kCooling || phase == ScanPhase::kExposing ||
         phase == ScanPhase::kFetching;
}

/// What every frame is told with, kept or not.
Json frame_event(const std::string& session, int index, int led, ShotRole role, Polariser polariser,
                 const capture::FrameFinding& finding) {
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  return {{"session", session},
          {"index", index},
          {"led", led},
          {"role", name_of(role)},
          {"polariser", name_of(polariser)},
          {"code", finding.code},
          {"level", number(finding.level)},
          {"misfit", number(finding.misfit)}};
}

}  // namespace

RigKeeper::RigKeeper(capture::Rig rig, Attendance& attendance, const Screens& screens, RunScan run,
                     EventLog& events, Logbook& log, FramePictures& pictures)
    : rig_(std::move(rig)),
      attendance_(attendance),
      screens_(screens),
      run_(std::move(run)),
      events_(events),
      log_(log),
      pictures_(pictures) {
  tell_status_locked();
}

RigKeeper::~RigKeeper() {
  scan_.request_stop();
}

void RigKeeper::tell_status() {
  const std::lock_guard lock(mutex_);
  tell_status_locked();
}

Result<void> RigKeeper::begin(capture::ScanRequest request, const std::string& by) {
  return begin(std::move(request), by, run_, true, [] {});
}

Result<void> RigKeeper::begin_work(capture::ScanRequest request, const std::string& by, RunScan work,
                                   std::function<void()> ended) {
  return begin(std::move(request), by, std::move(work), false, std::move(ended));
}

Result<void> RigKeeper::begin(capture::ScanRequest request, const std::string& by, RunScan work, bool is_scan,
                              std::function<void()> ended) {
  const std::lock_guard lock(mutex_);
  if (running_ || stopping_) {
    return Error{ErrorKind::kTryAgain, "the rig is busy", rig_.name,
                 running_ ? "it scans " + status_.session : "the daemon is ending",
                 "wait for its end, or cancel it"};
  }
  running_ = true;
  busy_(true);
  status_ = {};
  status_.state = RigStatus::State::kConnecting;
  status_.session = name_of_session(request);
  status_.by = by;
  for (const int led : request.leds) status_.leds.emplace_back().led = led;
  pace_ = {};
  pause_ = false;
  request_ = is_scan ? std::optional(request) : std::nullopt;
  begun_ = is_scan && !request.again ? Screens::Clock::now() : Screens::Clock::time_point();
  show_kept_locked();
  tell_status_locked();
  // The last one's thread has done its last deed once running_ is false: joining it here takes no time.
  scan_ = std::jthread([this, request = std::move(request), by, work = std::move(work), is_scan,
                        ended = std::move(ended)](const std::stop_token& cancel) {
    log_.add("scan_began", fmt::format("{} of {}", name_of_session(request), request.fabric),
             {{"session", name_of_session(request)}, {"fabric", request.fabric}, {"by", by}});
    logged_.clear();
    on_end(request, scan_with_devices(request, work, cancel), is_scan);
    ended();
  });
  return {};
}

Result<void> RigKeeper::pause() {
  const std::lock_guard lock(mutex_);
  if (!running_) return nothing_runs(rig_.name, "start one");
  if (status_.scan.phase == capture::ScanPhase::kFinishing) {
    return Error{ErrorKind::kTryAgain, "the scan is about to end", rig_.name, "its last frame is kept",
                 "wait for its end"};
  }
  pause_ = true;
  return {};
}

Result<void> RigKeeper::resume(const std::string& by) {
  std::optional<capture::ScanRequest> again;
  {
    const std::lock_guard lock(mutex_);
    const bool finished =
        status_.state == RigStatus::State::kIdle && status_.scan.phase == capture::ScanPhase::kComplete;
    if (!running_ && request_ && !finished) again = request_;
    if (!running_ && !again) {
      return nothing_runs(rig_.name, "start a scan with the name of the session to be resumed");
    }
    pause_ = false;
  }
  if (again) return begin(std::move(*again), by);
  return {};
}

Result<void> RigKeeper::cancel() {
  const std::lock_guard lock(mutex_);
  if (!running_) return nothing_runs(rig_.name, "start one");
  scan_.request_stop();
  return {};
}

bool RigKeeper::stop(std::chrono::milliseconds most) {
  std::unique_lock lock(mutex_);
  stopping_ = true;
  scan_.request_stop();
  return ended_.wait_for(lock, most, [&] { return !running_; });
}

Result<capture::RigDevices> RigKeeper::open_devices(const std::stop_token& cancel) {
  const auto patience = std::chrono::duration<double>(capture::ScanOptions().device_patience_s);
  const auto until = std::chrono::steady_clock::now() + patience;
  for (;;) {
    Result<capture::RigDevices> devices = attendance_.lend();
    if (devices || devices.error().kind != ErrorKind::kNoDevice || std::chrono::steady_clock::now() >= until)
      return devices;
    log_once("waiting", devices.error().message());
    std::unique_lock lock(mutex_);
    if (std::string why = devices.error().message(); why != status_.scan.why) {
      status_.scan.why = std::move(why);
      tell_status_locked();
    }
    ended_.wait_for(lock, cancel, kBetweenSearches, [] { return false; });
    if (cancel.stop_requested()) {
      return Error{ErrorKind::kInterrupted, "scan was stopped", rig_.name, "on request",
                   "run the same command again to go on"};
    }
  }
}

Result<capture::ScanOutcome> RigKeeper::scan_with_devices(const capture::ScanRequest& request,
                                                          const RunScan& work,
                                                          const std::stop_token& cancel) try {
  Result<capture::RigDevices> devices = open_devices(cancel);
  if (!devices) return std::move(devices).error();
  const Lent lent = {attendance_, std::move(*devices)};
  {
    const std::lock_guard lock(mutex_);
    status_.devices_open = true;
  }
  WatchedCamera camera(
      *lent.devices.camera, [this](const capture::CameraFacts& facts) { on_facts(facts); },
      [this](const std::vector<double>& times_us) { attendance_.know_exposures(times_us); });
  const capture::ScanEvents events = {
      [this](const capture::ScanStatus& status) { on_status(status); },
      [&](const capture::KeptFrame& frame) { on_kept(request, frame); },
      [&](const capture::RefusedFrame& frame) { on_refused(request, frame); }};
  return work(request, *lent.devices.lamps, camera, events, {cancel, &pause_, [this] { pause_ = true; }});
} catch (const std::exception& thrown) {
  return error_of_exception(thrown, name_of_session(request));
}

/// What comes again and again until it passes is written once.
void RigKeeper::log_once(const char* event, const std::string& why) {
  if (std::exchange(logged_, why) != why) log_.add(event, why);
}

// What an earlier run has kept.
void RigKeeper::show_kept_locked() {
  if (!request_) return;
  const Result<Session> session = read_session(request_->session);
  if (!session) return;  // a new one, or the scan says what is wrong with it
  for (const Shot& shot : session->shots) {
    LedStatus* led = lit_shot_of(shot.led, shot.role, shot.polariser);
    if (led == nullptr || shot.superseded_by || shot.index == request_->again) continue;
    led->state = LedStatus::State::kKept;
    led->takes = 1;
  }
}

// Where the shot that lights a LED for the first time stands, or lights it again at another exposure; null
// for all others.
LedStatus* RigKeeper::lit_shot_of(int led, ShotRole role, Polariser polariser) {
  if (!request_) return nullptr;
  const auto& states = request_->polariser.states;
  const bool is_other_state = !states.empty() && polariser != states.front();
  const bool is_its_shot = role == ShotRole::kLit || (request_->again && role == ShotRole::kBracket);
  if (!is_its_shot || is_other_state) return nullptr;
  const auto found = std::ranges::find(status_.leds, led, &LedStatus::led);
  return found != status_.leds.end() ? &*found : nullptr;
}

// No light is lit yet in the first of these phases.
void RigKeeper::on_status(const capture::ScanStatus& status) {
  const bool is_dark = screens_.go_black() && exposes(status.phase);
  if (is_dark) screens_.wait_until_announced(begun_);
  const bool was_dark = tell_scan(status, is_dark);
  if (is_dark && !was_dark) screens_.wait_until_black();
}

/// Whether screens were to be black before.
bool RigKeeper::tell_scan(const capture::ScanStatus& status, bool is_dark) {
  if (status.phase == capture::ScanPhase::kRecovering) {
    log_once("recovering", status.why);
  } else if (status.phase == capture::ScanPhase::kPaused) {
    log_once("paused", status.why);
  } else {
    logged_.clear();
  }
  const std::lock_guard lock(mutex_);
  const bool was_dark = std::exchange(status_.is_dark, is_dark);
  pace_.follow(status);
  status_.scan = status;
  if (LedStatus* led = lit_shot_of(status.led, status.role, status.polariser); led != nullptr) {
    const bool is_kept = led->state == LedStatus::State::kKept;
    if (status.phase == capture::ScanPhase::kExposing && !is_kept) led->state = LedStatus::State::kExposing;
    if (status.phase == capture::ScanPhase::kFetching && !is_kept) led->state = LedStatus::State::kChecking;
  }
  switch (status.phase) {
    case capture::ScanPhase::kConnecting:
      status_.state = RigStatus::State::kConnecting;
      break;
    case capture::ScanPhase::kPaused:
      status_.state = RigStatus::State::kPaused;
      break;
    default:
      status_.state = RigStatus::State::kScanning;  // until on_end() says how it ended
  }
  tell_status_locked();
  return was_dark;
}

void RigKeeper::on_kept(const capture::ScanRequest& request, const capture::KeptFrame& frame) {
  pictures_.prepare({request.session / frame.shot.file, frame.shot.sha256, frame.histogram_rgb});
  const std::string name = name_of_session(request);
  const auto& rgb = frame.histogram_rgb;
  Json event = frame_event(name, frame.shot.index, frame.shot.led, frame.shot.role, frame.shot.polariser,
                           frame.finding);
  event["kept"] = true;
  event["clipped_rgb"] = {rgb[0].clipped, rgb[1].clipped, rgb[2].clipped};
  event["warnings"] = frame.warnings;
  event["thumbnail"] = fmt::format("/api/v1/sessions/{}/frames/{}/thumbnail?sha256={}", name,
                                   frame.shot.index, frame.shot.sha256);
  {
    const std::lock_guard lock(mutex_);
    if (LedStatus* led = lit_shot_of(frame.shot.led, frame.shot.role, frame.shot.polariser); led != nullptr) {
      *led = {frame.shot.led, LedStatus::State::kKept, led->takes + 1, frame.finding,
              std::max({rgb[0].clipped, rgb[1].clipped, rgb[2].clipped})};
    }
  }
  log_.add("frame", fmt::format("{} is kept", frame.shot.file), event);
  event["histogram"] = to_json(rgb);
  events_.add("frame", event);
}

void RigKeeper::on_refused(const capture::ScanRequest& request, const capture::RefusedFrame& frame) {
  Json event = frame_event(name_of_session(request), frame.index, frame.led, frame.role, frame.polariser,
                           frame.finding);
  event["kept"] = false;
  event["why"] = frame.why;
  {
    const std::lock_guard lock(mutex_);
    if (LedStatus* led = lit_shot_of(frame.led, frame.role, frame.polariser); led != nullptr)
      *led = {frame.led, LedStatus::State::kRefused, led->takes + 1, frame.finding, 0};
  }
  log_.add("frame_refused", frame.why, event);
  events_.add("frame", event);
}

void RigKeeper::on_facts(const capture::CameraFacts& facts) {
  const std::lock_guard lock(mutex_);
  status_.camera = facts;
}

void RigKeeper::on_end(const capture::ScanRequest& request, const Result<capture::ScanOutcome>& outcome,
                       bool is_scan) {
  const bool cancelled = !outcome && outcome.error().kind == ErrorKind::kInterrupted;
  Json record = {{"session", name_of_session(request)}};
  if (outcome) {
    record["frames_resumed"] = outcome->frames_resumed;
    record["frames_retaken"] = outcome->frames_retaken;
    record["warnings"] = outcome->warnings;
    log_.add("scan_complete", name_of_session(request), std::move(record));
    if (is_scan) scanned_(request);
  } else {
    record["error"] = json_of(outcome.error());
    log_.add(cancelled ? "scan_cancelled" : "scan_failed", outcome.error().message(), std::move(record));
  }
  const std::lock_guard lock(mutex_);
  if (outcome) {
    status_.scan.phase = capture::ScanPhase::kComplete;
    status_.warnings = outcome->warnings;
  } else {
    status_.scan.phase = cancelled ? capture::ScanPhase::kCancelled : capture::ScanPhase::kFailed;
    status_.scan.why = outcome.error().message();
    if (!cancelled) status_.error = outcome.error();
    // What cannot be done is not gone on with.
    if (outcome.error().kind == ErrorKind::kUsage) request_.reset();
  }
  for (LedStatus& led : status_.leds) {
    const bool is_open = led.state == LedStatus::State::kExposing || led.state == LedStatus::State::kChecking;
    if (is_open) led.state = LedStatus::State::kWaiting;
  }
  status_.state = outcome || cancelled ? RigStatus::State::kIdle : RigStatus::State::kFailed;
  status_.scan.led = 0;
  status_.is_dark = false;
  status_.devices_open = false;
  running_ = false;
  busy_(false);
  tell_status_locked();
  ended_.notify_all();
}

RigStatus RigKeeper::status_locked() const {
  RigStatus status = status_;
  Attendance::Status attended = attendance_.status();
  if (running_) status.left_s = pace_.left_s();
  // Nobody knows how long a device will be waited for.
  const bool is_announced =
      screens_.go_black() && begun_ != Screens::Clock::time_point() && status.scan.why.empty();
  if (status.state == RigStatus::State::kConnecting && is_announced) {
    const std::chrono::duration<double> left = begun_ + Screens::kAnnounced - Screens::Clock::now();
    status.dark_in_s = std::max(0.0, left.count());
  }
  const bool is_finished = status.scan.phase == capture::ScanPhase::kComplete;
  status.can_go_on = !running_ && request_ && !is_finished;
  const bool is_free = status.state == RigStatus::State::kIdle || status.state == RigStatus::State::kFailed;
  if (is_free && attended.is_open) {
    status.state = RigStatus::State::kAttended;
    status.devices_open = true;
    status.can_light_s = attended.can_light_s;
  }
  if (attended.camera && !status.camera) status.camera = attended.camera;
  status.exposures_us = std::move(attended.exposures_us);
  status.is_dark = status.is_dark || attended.is_dark;
  status.lit = attended.lit;
  status.controls = controls_();
  status.place = place_();
  return status;
}

RigStatus RigKeeper::status() const {
  const std::lock_guard lock(mutex_);
  return status_locked();
}

std::string RigKeeper::session() const {
  const std::lock_guard lock(mutex_);
  return running_ ? status_.session : "";
}

}  // namespace weft::app
