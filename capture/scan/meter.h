// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capture/scan/histogram.h"
#include "capture/scan/light_fit.h"
#include "core/base/json_document.h"
#include "core/base/result.h"

namespace weft::capture {

// One exposure for all shots of a scan, from test shots of the cloth itself.

/// The brightest photosites (99.9 percent are below, by channel) of the brightest LED come to this share of
/// the way from black to white.
inline constexpr double kMeteredTo = 0.8;
/// All but one in 100 000 stay below this one.
inline constexpr double kMeteredBelow = 0.95;

/// A test shot, and how bright it is.
struct MeteredShot {
  int led = 0;
  double exposure_us = 0;
  Brightness seen;

  bool is_full() const;
  /// Neither full nor too dark: longest_us() holds.
  bool is_readable() const;
  /// The longest exposure at which the cloth under this LED stays below both limits.
  double longest_us() const;
  /// What to try next: longest_us(), or a shorter or longer one where this shot cannot be read.
  double next_us() const;
};

struct Metering {
  double exposure_us = 0;  ///< that the camera has
  int led = 0;             ///< the brightest, which decides
  double wanted_us = 0;    ///< longest_us() of its test shot
  std::vector<MeteredShot> test_shots;
  std::vector<std::string> warnings;
};
/// {"led", "wanted_us", "test_shots"} for session.json.
Json to_json(const Metering& metering);

struct MeterInput {
  std::vector<int> leds;                 ///< that will be lit, from 1
  std::vector<double> expected;          ///< of each of them, any unit: light on a flat cloth; empty: unknown
  std::vector<double> shutter_times_us;  ///< rising
  double start_us = 0;                   ///< of the first test shot
};

/// What a scan of these LEDs begins with. Where the calibrated lights are known they tell what to expect: the
/// first test shot then holds white cloth.
MeterInput meter_input(std::vector<int> leds, std::vector<double> shutter_times_us,
                       const std::optional<PatchLights>& lights, double iso);

/// A test shot: how bright the cloth is under a LED at an exposure.
using TestShot = std::function<Result<Brightness>(int led, double exposure_us)>;

/// Finds the exposure. With `expected`, two LEDs are tried, the one that should be brightest and the one most
/// unlike it; where they agree with it the others are believed, else all are tried. Errors are those of the
/// test shots, and kBadData where no exposure of the camera suits.
Result<Metering> meter(const MeterInput& input, const TestShot& shoot);

/// What that would come to, by one test shot and what it lets expect of the other LEDs (where nothing is
/// expected, that none is brighter); nothing where the shot is full or too dark.
std::optional<double> metered_by(const MeteredShot& shot, const MeterInput& input);

}  // namespace weft::capture
