// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "capture/devices.h"
#include "capture/scan/frame_check.h"
#include "capture/scan/scan.h"
#include "core/base/result.h"

namespace weft::capture {

/// What a scan tells of itself: one call at a time, from whatever thread.
class Report {
 public:
  explicit Report(const ScanEvents& events) : events_(events) {}
  void change(const std::function<void(ScanStatus&)>& change);
  void phase(ScanPhase phase, std::string why = {});
  void kept(const KeptFrame& frame);
  void refused(const RefusedFrame& frame);
  ScanPhase phase() const;

 private:
  const ScanEvents& events_;
  mutable std::mutex mutex_;
  ScanStatus status_;
};

/// What lights an exposure, and how the film before the lens stands.
struct ShotLight {
  int led = 0;                     ///< from 1; 0: none
  ShotRole role = ShotRole::kLit;  ///< kBelow: the light below; kBlade: a person is waited for
  Polariser polariser = Polariser::kNone;
  int second = 0;  ///< a LED that is lit together with `led`; 0: none
};

/// Takes single photographs and gets over what devices do: LEDs are off whenever no shutter is open, every
/// fault is followed by recover(), and what a camera delivers is checked to be the next by its count.
class Shooter {
 public:
  Shooter(Lamps& lamps, Camera& camera, const PolariserUse& polariser, const ScanControl& control,
          const ScanOptions& options, Report& report)
      : lamps_(lamps),
        camera_(camera),
        use_(polariser),
        control_(control),
        options_(options),
        report_(report) {}

  /// Finds both devices, waits for one that is not there. kInterrupted, kNoDevice, kBadData.
  Result<CameraFacts> connect();
  /// The last count of shots that the session knows.
  void follow(std::optional<std::uint32_t> image_number) { count_.follow(image_number); }
  Result<std::vector<double>> shutter_times_us();
  /// One photograph in this light to `file` with an ending. Tries again where that may help; in between
  /// `clear` removes what a failed take left. Waits while the scan is paused.
  Result<Photograph> take(const ShotLight& light, const ExposureSettings& exposure,
                          const std::filesystem::path& file, const std::function<void()>& clear);
  Result<void> lamps_off();
  bool is_cancelled() const { return control_.cancel.stop_requested(); }
  bool is_paused() const { return control_.pause != nullptr && control_.pause->load(); }
  int retaken() const { return retaken_; }
  const LongWaits& long_waits() const { return long_waits_; }

 private:
  Result<Photograph> take_once(const ShotLight& light, const ExposureSettings& exposure,
                               const std::filesystem::path& file, bool is_metering);
  /// Where the board turns the film: turns it, unless it stands so.
  Result<void> turn(Polariser state);
  /// Lights LEDs as soon as they are cool. When they go out at the earliest.
  Result<std::chrono::steady_clock::time_point> light(const std::vector<int>& leds,
                                                      std::chrono::duration<double> most_lit);
  Result<void> let_cool(int led, double cools_s);
  Result<void> wait_while_paused(const std::string& why = "paused on request; resume to go on");
  /// Until a person says that the blade lies there.
  Result<void> wait_for_blade(int led);
  /// Whether devices answer again after `error`; else the error that ends the scan.
  Result<void> recover(const Error& error);
  Result<void> wait_for(const std::function<Result<void>()>& find);

  Lamps& lamps_;
  Camera& camera_;
  const PolariserUse& use_;
  const ScanControl& control_;
  const ScanOptions& options_;
  Report& report_;
  ImageCount count_;
  LongWaits long_waits_;
  std::optional<ExposureSettings> set_;  ///< what the camera is set to
  std::optional<Polariser> turned_;      ///< how the board has turned the film
  bool lamps_failed_ = false;
  int retaken_ = 0;
};

/// The error of a scan that was cancelled.
Error cancelled(const std::string& where);

}  // namespace weft::capture
