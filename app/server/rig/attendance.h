// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/server/rig/frame_pictures.h"
#include "app/server/rig/screens.h"
#include "capture/framing/focus.h"
#include "capture/rig.h"
#include "capture/rig_devices/rig_devices.h"
#include "capture/scan/light_fit.h"
#include "capture/scan/meter.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

/// A photograph that a person looks at and nobody keeps.
struct TestShot {
  int id = 0;
  int led = 0;                                  ///< 0: none was lit
  double exposure_us = 0;                       ///< of the camera's own
  std::optional<FrameFile> frame;               ///< once it is taken
  Size size = {};                               ///< of that
  std::optional<double> suggested_us;           ///< what the meter of a scan comes to; none without a LED
  std::optional<capture::FocusStanding> focus;  ///< among those of its LED and exposure, one after another
  std::optional<Error> error;                   ///< why it is not
};

/// The devices of a rig, held open while a person attends it: to see what each LED lights, to frame, to
/// focus. They are open until kLease after the last call, and a scan takes them over as they are and gives
/// them back.
///
/// A light is lit until kLightLease after it was last asked for. The time is the board's own: it is dark then
/// whatever becomes of the client or of this process, whose death its dead-man timer ends sooner.
///
/// A device that fails closes them: status().error says why. Safe from any thread.
class Attendance {
 public:
  static constexpr std::chrono::minutes kLease{5};
  static constexpr std::chrono::milliseconds kLightLease{1500};
  static constexpr std::chrono::seconds kTurn{3};
  static constexpr std::size_t kKeptShots = 8;
  static constexpr std::chrono::seconds kLookLease{3};

  struct Status {
    bool is_open = false;             ///< for a person: not while a scan has them
    std::string doing;                ///< "opening", "shooting", "scanning"; empty: nothing
    std::vector<int> lit;             ///< as asked for last, until its lease ends
    bool is_live = false;             ///< the camera is in live view
    bool is_dark = false;             ///< a test shot is taken: screens are to be black
    std::vector<double> can_light_s;  ///< by LED: how long it may be lit at once from now; empty: not known
    std::optional<capture::CameraFacts> camera;
    std::vector<double> exposures_us;  ///< that the camera has, rising; empty: it was not asked yet
    std::optional<Error> error;
  };
  struct Told {
    std::function<void()> changed;              ///< status() is another one
    std::function<void(const TestShot&)> shot;  ///< was taken, or failed
  };

  /// Test shots lie in `folder`, the last kKeptShots of them.
  Attendance(capture::Rig rig, capture::OpenDevices open, std::filesystem::path folder,
             const Screens& screens, Told told);
  ~Attendance();

  /// Opens the devices, which takes seconds, or renews their lease. Errors: those of capture::open_devices()
  /// and Camera::connect(); kTryAgain while a scan has them.
  Result<void> open();
  /// Dark and closed.
  Result<void> close();

  struct Lit {
    std::vector<int> leds;  ///< that are lit now
    double rest_s = 0;      ///< that those asked for have to rest before; 0 where they are lit
  };
  /// Lights these LEDs (none: all off) until kLightLease from now. Errors: kTryAgain where the devices are
  /// closed or a scan has them, kUsage for LEDs that are not there, those of Lamps::light().
  Result<Lit> light(const std::vector<int>& leds);
  /// Lights one LED for as long as somebody looks: after kTurn another one, that which may be lit longest.
  /// The same errors.
  Result<Lit> light_in_turns();
  /// Begins a test shot by this LED (0: none) and gives its id. The light that was lit comes back after it.
  /// One that is full or too dark is followed by the meter's own, once in a series of like ones. Errors as
  /// light() and settable_us(); kTryAgain while another one is taken.
  Result<int> shoot(int led, double exposure_us);
  /// The exposure of the camera's own that is meant by this one, which it is itself as long as those are not
  /// known; kUsage where it lies beyond all of them.
  Result<double> settable_us(double exposure_us) const;
  /// The camera has these.
  void know_exposures(std::vector<double> exposures_us);
  /// One of the last; kNoInput where it is none of these.
  Result<TestShot> shot(int id) const;

  /// What the camera's finder shows (JPEG), and its number, which rises. Live view begins with the first look
  /// and ends kLookLease after the last one, before a test shot, and when a scan takes the devices. One
  /// picture serves all who ask with an earlier number at once. Errors: kTryAgain as light(), and those of
  /// Camera::look().
  struct Look {
    std::int64_t number = 0;
    std::string jpeg;
  };
  Result<Look> look(std::int64_t after);

  Status status() const;

  /// The devices, for a scan: those that are open, else opened now. Waits for a test shot under way.
  Result<capture::RigDevices> lend();
  /// No shot begins after this; whether the last one has ended. Its board is dark once this process is gone.
  bool stop(std::chrono::milliseconds most);

  /// What lend() gave; closed where nobody attends the rig any more.
  void take_back(capture::RigDevices devices);

 private:
  using Clock = std::chrono::steady_clock;
  Result<void> open_held();
  Result<double> light_held(const std::vector<int>& leds, double most_s);
  void feel_heat_held();
  void take(TestShot shot);
  Result<FrameFile> photograph_held(int led, double exposure_us, const std::string& stem);
  void look_at_held(TestShot& shot);
  std::optional<double> suggested_held(const capture::MeteredShot& shot);
  bool is_wanted() const;    ///< for a scan, or to end
  void keep(TestShot shot);  ///< the next one may begin from here on
  void fail_held(const Error& error);
  void end_look_held();
  void watch(const std::stop_token& stop);
  void renew();
  template <typename Change>
  void change(const Change& change);

  const capture::Rig rig_;
  const capture::OpenDevices open_;
  const std::filesystem::path folder_;
  const Screens& screens_;
  const Told told_;

  std::mutex devices_mutex_;  ///< of the devices; held while one of them works
  std::optional<capture::RigDevices> devices_;
  std::optional<capture::ExposureSettings> set_;
  Look look_;                                     ///< the last one
  std::optional<capture::PhotositeNoise> noise_;  ///< by the rig's calibration
  std::optional<capture::PatchLights> lights_;    ///< by that
  capture::FocusSeries series_;
  int series_led_ = -1;
  double series_us_ = 0;
  struct Metered {
    capture::Brightness seen;  ///< of the test shot that did not tell
    double exposure_us = 0;
  };
  std::optional<Metered> metered_;  ///< by the meter's own test shots, in this series

  mutable std::mutex mutex_;  ///< of all that follows; held for moments
  std::condition_variable_any changed_;
  Status status_;
  bool is_lent_ = false, is_shooting_ = false, is_stopping_ = false;
  Clock::time_point open_until_, lit_until_, look_until_;
  std::vector<int> wanted_;
  int turn_ = 0;  ///< the LED whose turn it is, from turn_began_ on
  Clock::time_point turn_began_;
  std::vector<double> can_light_s_;  ///< at felt_
  Clock::time_point felt_;
  std::deque<TestShot> shots_;
  int newest_ = 0;
  std::jthread shooter_, watch_;
};

/// {"id", "led", "exposure_us", "state" (taking, taken, failed), "width", "height", "suggested_us",
/// "clipped_rgb", "histogram", "focus", "error"}: of one that is taken the histogram is counted now, if it is
/// not yet.
Json document_of(const TestShot& shot, FramePictures& pictures);

/// {"open", "doing", "lit", "error"}.
Json to_json(const Attendance::Status& status);

}  // namespace weft::app
