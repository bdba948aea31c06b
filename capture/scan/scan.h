// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "capture/devices.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"
#include "core/rig/cloth_pose.h"
#include "core/rig/session.h"

namespace weft::capture {

/// The film before the lens in a scan.
struct PolariserUse {
  /// Each LED is photographed in each of these, one state after the other; the first is what is solved.
  /// Empty: there is no film.
  std::vector<Polariser> states;
  bool is_turned = false;  ///< by the board; else it stands in the only state
  double settle_s = 0.5;   ///< from the command to turn until it stands
};

/// One scan of one cloth, as it is asked for.
struct ScanRequest {
  std::filesystem::path session;  ///< NAME.weft: not there yet, or an unfinished session of the same rig
  std::string fabric;
  double cloth_height_mm = 0;
  ClothPose pose;
  Json metadata =
      Json::object();        ///< id, tags, composition, weight, construction, side, notes: kept as given
  Json calibrated = {};      ///< how old the calibration is, and its last check, kept as given
  Json accepted_moved = {};  ///< of a rig that is known to have moved: {"why", "degrees"}, kept as given
  std::string rig;
  std::filesystem::path calibration;  ///< folder, copied into the session; empty: none, and no light model
  ExposureSettings exposure;          ///< exposure_us 0: metered
  std::vector<int> leds;              ///< empty: all of the board
  /// Goes on though the first lit frame of an exposure that was asked for is good for nothing.
  bool any_exposure = false;
  bool repeat = true;             ///< the first LED and the dark shot once more at the end
  std::optional<double> bracket;  ///< each LED once more at this times the exposure, 0.001 to 100
  PolariserUse polariser;
  bool below = false;   ///< the cloth once by the light below it
  double below_us = 0;  ///< exposure of that; 0: metered
  /// This LED once more at the end, with a straight edge above the cloth that a person has laid there.
  std::optional<int> blade;
  std::filesystem::path copy;  ///< folder for a second copy of the finished session; empty: none
  /// Instead of all that: this lit or dark shot of the finished session once more, at its exposure. The new
  /// frame gets the next number and stands for the old one, which stays. With an exposure of its own the new
  /// frame is a bracket of the LED, and supersedes none.
  std::optional<int> again;
};

/// What a scan does at the moment (the machine is drawn in docs/reliability.md).
enum class ScanPhase {
  kConnecting,
  kMetering,
  kCooling,  ///< the next LED was lit for so long that it must rest; `why` says for how many seconds
  kExposing,
  kFetching,
  kRecovering,
  kPaused,
  kFinishing,
  kComplete,
  kCancelled,
  kFailed
};
const char* name_of(ScanPhase phase);  ///< "connecting"

/// Counts of one channel of a raw frame in 64 equal bins from black to white, and what is at or above white.
struct RawHistogram {
  std::array<std::uint32_t, 64> bins = {};
  double clipped = 0;  ///< share
};

/// What the pixels of a frame say of it.
struct FrameFinding {
  /// "dark", "dim", "swapped", "stays_lit", "room_light", "changed", "clipped"; of a frame that cannot be
  /// used at all "damaged" or "unlike" (the others). "": nothing is wrong.
  std::string code;
  std::optional<double> level, misfit;  ///< as in Verdict (light_evidence.h)
};

/// A frame that is kept. Its finding has a code where there is a warning, or where it is clipped, of which
/// the outcome speaks for all frames together.
struct KeptFrame {
  Shot shot;
  std::array<RawHistogram, 3> histogram_rgb;
  std::vector<std::string> warnings;
  FrameFinding finding = {};
};

/// A frame that is not kept, or that leaves the session because of what a later one says of it.
struct RefusedFrame {
  int index = 0;
  int led = 0;
  ShotRole role = ShotRole::kLit;
  Polariser polariser = Polariser::kNone;
  FrameFinding finding;
  std::string why;  ///< one sentence with what to do
};

/// Where a scan stands.
struct ScanStatus {
  ScanPhase phase = ScanPhase::kConnecting;
  int led = 0;                             ///< being photographed
  ShotRole role = ShotRole::kLit;          ///< of the shot
  Polariser polariser = Polariser::kNone;  ///< at that
  int frames = 0;                          ///< kept
  int frames_planned = 0;
  double exposure_us = 0;
  std::string why;  ///< of a pause, a rest, a failure, a recovery: one sentence with what to do
};

/// Called from the scan's own threads, one call at a time.
struct ScanEvents {
  std::function<void(const ScanStatus&)> status = [](const ScanStatus&) {};
  std::function<void(const KeptFrame&)> kept = [](const KeptFrame&) {};
  std::function<void(const RefusedFrame&)> refused = [](const RefusedFrame&) {};
};

/// What a person may ask of a running scan, from any thread.
struct ScanControl {
  std::stop_token cancel = {};               ///< stops after the shot on its way; the session can be resumed
  const std::atomic<bool>* pause = nullptr;  ///< while true no new shot begins, all LEDs are off
  /// Called before a shot that a person makes ready: sets `pause`, until they have. Empty: it is ready.
  std::function<void()> wait_for_person = {};
};

/// How patient a scan is.
struct ScanOptions {
  double device_patience_s = 30;  ///< how long a device that is gone is waited for before the scan ends
  int tries_per_shot = 3;         ///< takes of one shot before the scan ends
  double lamp_margin_s = 8;       ///< how long a LED may wait for the camera to open its shutter
};

/// A finished scan.
struct ScanOutcome {
  Session session;
  int frames_resumed = 0;  ///< that were there before
  int frames_retaken = 0;  ///< for a fault on the way
  std::vector<std::string> warnings;
};

/// Scans a cloth: see docs/reliability.md for what each fault leads to. The session folder is the journal:
/// session.json is replaced after each synced frame, so that the same call resumes at the first frame that is
/// missing, whatever ended the last one. A frame is kept only if its own count and time, its size and digest,
/// and its pixels under the calibration's light model say that it is the photograph of this LED.
///
/// Errors: kCannotCreate (the session is finished, another rig's, or cannot be made), kInputOutput (no room
/// for the whole scan, checked before), kNoDevice, kBadData (camera or light not as calibrated: the sentence
/// names LED and cause), kTryAgain, kProtocol, kInterrupted. The session keeps what it has in every case.
Result<ScanOutcome> scan(const ScanRequest& request, Lamps& lamps, Camera& camera, const ScanEvents& events,
                         const ScanControl& control, const ScanOptions& options = {});

}  // namespace weft::capture
