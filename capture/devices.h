// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/rig/session.h"

namespace weft::capture {

// The two devices of a rig as a scan sees them. What their errors mean to it:
//   kNoDevice   the device is gone (unplugged, switched off, held by another program): wait for it or pause;
//   kTryAgain   it did not answer in time: recover() and take the shot again;
//   kProtocol   it answered against its protocol: the same;
//   kBadData    it is there and set up wrongly (dial, battery, serial number): a person must act.

/// The LED board.
class Lamps {
 public:
  virtual ~Lamps() = default;

  virtual int leds() const = 0;
  /// Lights these LEDs (from 1; at most two; none: all off) and no other, until the next call or for at most
  /// `most_s` seconds, whichever ends first. Returns 0 when the board has said that it is so. Above 0: they
  /// are too warm, all are off; to be asked again after so many seconds.
  virtual Result<double> light(std::span<const int> leds, double most_s) = 0;
  /// After an error: finds the board again, all off. The same board or an error.
  virtual Result<void> recover() = 0;

  /// Whether it has outputs for a light below the cloth, which is LED leds() + 1 and lit alone, and for a
  /// polariser. What hangs on them the rig file says.
  virtual bool has_more_outputs() const = 0;
  /// Turns the polariser, until the next call or recover(), which leaves it parallel. kUsage for kNone, and
  /// where there are no such outputs.
  virtual Result<void> polarise(Polariser state) = 0;
  /// Seconds that each LED may be lit for at once, the light below last; none where the board cannot tell.
  virtual Result<std::vector<double>> can_light_s() = 0;
};

/// What a scan asks of a camera for each shot.
struct ExposureSettings {
  double exposure_us = 0;
  double iso = 100;
  double f_number = 8;

  friend bool operator==(const ExposureSettings&, const ExposureSettings&) = default;
};

/// What a camera says of itself.
struct CameraFacts {
  std::string model;
  std::string serial;
  std::string port;  ///< where it was found: "usb:001,007", "ptpip:127.0.0.1:15740:15740"
  ExposureSettings exposure;
  double battery = 1;              ///< share left
  double shutter_travel_s = 0;     ///< from its first row's exposure to that of the last; 0: nobody knows
  double clock_offset_s = 0;       ///< camera's clock minus this machine's
  double clock_uncertainty_s = 1;  ///< how far off the offset may be
};

/// A photograph that has landed on this machine's disk, synced.
struct Photograph {
  std::filesystem::path file;
  std::string sha256;
  std::uint64_t bytes = 0;
  std::string ending;                         ///< by its content: "dng", "nef"
  std::optional<std::uint32_t> image_number;  ///< the camera's own count of shots, from the file
  std::optional<double> taken_s;  ///< by the camera's clock, in seconds since 1970 of this machine's clock
  double triggered_s = 0;         ///< since 1970: when it was asked for
  double waited_s = 0;            ///< from then until the camera had it
  ExposureSettings exposure;      ///< as the file says
};

/// The camera.
class Camera {
 public:
  virtual ~Camera() = default;

  /// Finds the camera, checks that it is the rig's (model, serial number), that dial, battery, lens and
  /// storage allow a scan, sets everything that is not exposure (raw, memory of the camera as target, no
  /// autofocus, fixed white balance), and throws away what it still had to deliver.
  virtual Result<CameraFacts> connect() = 0;
  /// Sets the exposure and reads it back.
  virtual Result<CameraFacts> set(const ExposureSettings& exposure) = 0;
  /// Shutter times it can be set to, in us, rising.
  virtual Result<std::vector<double>> shutter_times_us() = 0;
  /// Takes one photograph and writes it to `file` with its ending added: whole, of the exposure that was set
  /// and of a time after it was asked for, or an error. `exposed` is called once the shutter
  /// has closed, while the picture is still on its way: light may change from then on.
  virtual Result<Photograph> take(const std::filesystem::path& file,
                                  const std::function<void()>& exposed) = 0;
  /// What its finder shows now: the bytes of a JPEG. Starts live view where it is off, which takes up to a
  /// second; then at the rate of the body. For framing only: the camera chooses its exposure. set() and
  /// take() end it first.
  virtual Result<std::string> look() = 0;
  /// Ends live view, which warms the sensor; nothing where it is off.
  virtual Result<void> stop_looking() = 0;
  /// After an error: ends whatever hangs and connects again, at most a few seconds.
  virtual Result<CameraFacts> recover() = 0;
};

}  // namespace weft::capture
