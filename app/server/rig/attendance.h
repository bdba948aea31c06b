// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/server/rig/attended_devices.h"
#include "app/server/rig/lamp_heat.h"
#include "app/server/rig/light_turns.h"
#include "app/server/rig/screens.h"
#include "app/server/rig/shot_reading.h"
#include "app/server/rig/test_shots.h"
#include "capture/rig.h"
#include "capture/rig_devices/rig_devices.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::app {

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

  /// Test shots lie in `folder`, the last TestShots::kKept of them.
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
  /// Lights one LED for as long as somebody looks, in turns (LightTurns). The same errors.
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
  template <typename Change>
  void change(const Change& change);
  void renew();
  bool is_wanted() const;  ///< for a scan, or to end
  void watch(const std::stop_token& stop);

  // With devices_mutex_ held.
  Result<void> open_held();
  void close_if_broken_held();
  void feel_heat_held();
  Result<double> light_held(const std::vector<int>& leds, double most_s);
  std::vector<int> light_again_held();
  void end_look_held();
  Result<FrameFile> photograph_held(int led, double exposure_us, const std::string& stem);
  Result<capture::Brightness> meter_shot_held(int led, double exposure_us);
  void photograph_and_read_held(TestShot& shot);

  void take(TestShot shot);
  void keep(TestShot shot);  ///< the next one may begin from here on

  const capture::Rig rig_;
  const capture::OpenDevices open_;
  const std::filesystem::path folder_;
  const Screens& screens_;
  const Told told_;

  std::mutex devices_mutex_;  ///< of the three that follow; held while a device works
  std::optional<AttendedDevices> devices_;
  Look look_;  ///< the last one
  ShotReader reader_;

  mutable std::mutex mutex_;  ///< of all that follows; held for moments, devices_mutex_ before it
  std::condition_variable_any changed_;
  Status status_;
  bool is_lent_ = false, is_shooting_ = false, is_stopping_ = false;
  Clock::time_point open_until_, lit_until_, look_until_;
  std::vector<int> wanted_;  ///< to be lit until then
  LightTurns turns_;
  LampHeat heat_;
  TestShots shots_;
  std::jthread shooter_;

  std::jthread watch_;  ///< ends leases, from begin to end
};

/// {"open", "doing", "lit", "error"}.
Json to_json(const Attendance::Status& status);

}  // namespace weft::app
