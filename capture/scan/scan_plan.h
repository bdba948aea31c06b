// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capture/devices.h"
#include "capture/scan/scan.h"
#include "core/base/json_document.h"
#include "core/rig/session.h"

namespace weft::capture {

/// One shot of a scan.
struct DueShot {
  int index = 0;  ///< order in the session, from 0
  int led = 0;    ///< from 1; 0: none
  ShotRole role = ShotRole::kLit;
  ExposureSettings exposure;
  Polariser polariser = Polariser::kNone;
  std::optional<int> supersedes = {};  ///< index of the shot that it stands for from then on
};

/// Which shots a scan takes, whatever their exposure. It is kept in session.json ("plan").
struct ShotList {
  std::vector<int> leds;
  bool repeat = true;                     ///< the first LED and the dark shot once more
  std::optional<double> bracket;          ///< times the exposure
  std::vector<Polariser> polariser = {};  ///< states of PolariserUse
  bool below = false;                     ///< the light below the cloth
  std::optional<int> blade = {};          ///< LED with the blade

  int count() const;
};
Json to_json(const ShotList& list);
ShotList asked_shots(const ScanRequest& request);

/// How long the shots are that are not exposed as the lit ones.
struct OtherTimes {
  double bracket_us = 0;
  double below_us = 0;
};

/// The shots in order: the dark one, the LEDs, the first LED again, each LED at the bracket's time, the LEDs
/// in the polariser's other states, the light below, the dark one again, the LED with the blade. The dark
/// shot is the first, because whatever lights it (a lamp in the room, a LED that stays lit) lights all the
/// others too; the last tells whether that changed.
std::vector<DueShot> plan_shots(const ShotList& list, const ExposureSettings& exposure,
                                const OtherTimes& times);

/// What was planned for a session's shots, in their order.
std::vector<DueShot> plan_of(const Session& session, const ExposureSettings& exposure,
                             const OtherTimes& times);
/// The shot of this index once more: kUsage where it is none that can be. `bracket_us`: as a bracket of its
/// LED.
Result<DueShot> shot_again(const Session& session, int index, const ExposureSettings& exposure,
                           std::optional<double> bracket_us);

/// "03_led04", "14_led01_parallel", "24_below", "26_led03_blade": its file without the ending.
std::string file_stem(const DueShot& shot);

/// The shots that the session does not have.
std::vector<DueShot> missing_shots(const std::vector<DueShot>& plan, const Session& session);

/// The time of `times_us` (rising) that is nearest to `wanted_us` by ratio; `wanted_us` where there is none.
double nearest_time_us(const std::vector<double>& times_us, double wanted_us);
/// The same, which is what a person means by `wanted_us`, if it lies at most a sixth of a stop beyond the
/// shortest or the longest time; else kUsage with these two.
Result<double> settable_time_us(const std::vector<double>& times_us, double wanted_us);
/// What to say where that is another time than what was asked for; empty: it is the same one.
std::string nearest_time_words(double wanted_us, double settable_us);

/// "LED 3", "the dark shot".
std::string name_of(const DueShot& shot);

/// That brackets are not what was asked for, or are of a time whose ratio to the exposure nobody measured.
std::vector<std::string> bracket_warnings(const ShotList& list, double exposure_us, double bracket_us,
                                          const std::optional<Calibration>& calibration);

}  // namespace weft::capture
