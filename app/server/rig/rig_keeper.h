// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "app/server/http/event_log.h"
#include "app/server/rig/attendance.h"
#include "app/server/rig/frame_pictures.h"
#include "app/server/rig/logbook.h"
#include "app/server/rig/rig_status.h"
#include "app/server/rig/scan_pace.h"
#include "app/server/rig/screens.h"
#include "capture/devices.h"
#include "capture/rig.h"
#include "capture/scan/scan.h"
#include "core/base/result.h"

namespace weft::app {

/// capture::scan, or what stands for it where no rig leads.
using RunScan =
    std::function<Result<capture::ScanOutcome>(const capture::ScanRequest&, capture::Lamps&, capture::Camera&,
                                               const capture::ScanEvents&, const capture::ScanControl&)>;

/// The state machine of a rig, drawn in docs/http.md:
///
///   idle, failed --begin--> connecting --> scanning <--> paused
///   connecting, scanning, paused --> idle (finished, cancelled) or failed (error says why)
///   idle, failed --devices opened for a person--> attended --closed--> idle
///
/// One scan at a time, on a thread of its own. A device that is not there (kNoDevice) is asked for every half
/// second in connecting, for as long as a scan waits for one that goes; its devices are those of
/// the attendance, or open while it runs and closed in idle and failed, so that other programs can use them.
/// Safe from any thread.
class RigKeeper {
 public:
  RigKeeper(capture::Rig rig, Attendance& attendance, const Screens& screens, RunScan run, EventLog& events,
            Logbook& log, FramePictures& pictures);
  ~RigKeeper();

  /// Hears whether a scan runs; set before the first begins. Must not call the keeper.
  void on_busy(std::function<void(bool)> busy) { busy_ = std::move(busy); }

  /// Hears of each scan that came to its end; set before the first begins.
  void on_scanned(std::function<void(const capture::ScanRequest&)> scanned) { scanned_ = std::move(scanned); }

  /// Hears who holds the controls; set before the first client comes. Must not call the keeper.
  void on_controls(std::function<std::string()> controls) { controls_ = std::move(controls); }
  /// Says how the rig is by its last scan (RigWatch::place()); set before the first begins. Must not call the
  /// keeper.
  void on_place(std::function<Json()> place) { place_ = std::move(place); }
  /// Tells all that follow how things are.
  void tell_status();

  /// Starts a scan, or resumes a session that is there. `by`: who asked for it, if that is known. kTryAgain
  /// while one runs.
  Result<void> begin(capture::ScanRequest request, const std::string& by);
  /// Has something else done with the devices, as a scan is: `work` hears of cancelling and pausing, and what
  /// it tells is told. `request` names it. `ended` is called once the rig is free again.
  Result<void> begin_work(capture::ScanRequest request, const std::string& by, RunScan work,
                          std::function<void()> ended);
  /// kTryAgain where there is nothing to pause, resume or cancel. Resuming what failed or was cancelled
  /// begins it again.
  Result<void> pause();
  Result<void> resume(const std::string& by);
  Result<void> cancel();

  RigStatus status() const;
  /// The name of the session being scanned; empty: none.
  std::string session() const;

  /// Cancels and waits; whether the scan has ended. It cannot begin another one after that.
  bool stop(std::chrono::milliseconds most);

 private:
  Result<capture::RigDevices> open_devices(const std::stop_token& cancel);
  Result<void> begin(capture::ScanRequest request, const std::string& by, RunScan work, bool is_scan,
                     std::function<void()> ended);
  Result<capture::ScanOutcome> scan_with_devices(const capture::ScanRequest& request, const RunScan& work,
                                                 const std::stop_token& cancel);
  void on_status(const capture::ScanStatus& status);
  bool tell_scan(const capture::ScanStatus& status, bool is_dark);
  void on_kept(const capture::ScanRequest& request, const capture::KeptFrame& frame);
  void on_refused(const capture::ScanRequest& request, const capture::RefusedFrame& frame);
  void on_facts(const capture::CameraFacts& facts);
  void on_end(const capture::ScanRequest& request, const Result<capture::ScanOutcome>& outcome, bool is_scan);
  void log_once(const char* event, const std::string& why);
  RigStatus status_locked() const;
  void show_kept_locked();
  LedStatus* lit_shot_of(int led, ShotRole role, Polariser polariser);
  void tell_status_locked() { events_.add("status", to_json(status_locked(), rig_)); }

  const capture::Rig rig_;
  Attendance& attendance_;
  const Screens& screens_;
  const RunScan run_;
  EventLog& events_;
  Logbook& log_;
  FramePictures& pictures_;

  std::function<void(bool)> busy_ = [](bool) {};
  std::function<void(const capture::ScanRequest&)> scanned_ = [](const capture::ScanRequest&) {};
  std::function<std::string()> controls_ = [] { return std::string(); };
  std::function<Json()> place_ = [] { return Json(); };
  mutable std::mutex mutex_;
  std::condition_variable_any ended_;  ///< or asked to end
  bool running_ = false;
  bool stopping_ = false;
  RigStatus status_;
  std::optional<capture::ScanRequest> request_;  ///< of the last scan; none: something else was done
  Screens::Clock::time_point begun_;             ///< when the scan that is announced began; zero: none is
  ScanPace pace_;
  std::atomic<bool> pause_ = false;
  std::string logged_;  ///< the last trouble that log_once() wrote; the scan's own
  std::jthread scan_;
};

}  // namespace weft::app
