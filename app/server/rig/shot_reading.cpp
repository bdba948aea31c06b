// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/shot_reading.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "capture/scan/histogram.h"

namespace weft::app {
namespace {

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

void ShotReader::calibrate(const Calibration& calibration) {
  noise_ = noise_of(calibration);
  lights_ = lights_of(calibration, rig_);
}

ShotReading ShotReader::read(const RawFrame& frame, int led, double exposure_us,
                             const std::vector<double>& exposures_us, const capture::TestShot& shoot) {
  if (led != series_.led || exposure_us != series_.exposure_us) series_ = {led, exposure_us, {}, {}};
  ShotReading reading;
  reading.size = frame.counts.size();
  reading.focus = series_.focus.add(capture::focus_of(frame, noise_));
  if (led > 0)
    reading.suggested_us =
        suggested_us({led, exposure_us, capture::brightness_of(frame)}, exposures_us, shoot);
  return reading;
}

std::optional<double> ShotReader::suggested_us(const capture::MeteredShot& shot,
                                               const std::vector<double>& exposures_us,
                                               const capture::TestShot& shoot) {
  std::vector<int> leds(static_cast<std::size_t>(rig_.leds));
  std::iota(leds.begin(), leds.end(), 1);
  const capture::MeterInput input =
      capture::meter_input(std::move(leds), exposures_us, lights_, rig_.scan.iso);
  if (const std::optional<double> read_us = capture::metered_by(shot, input)) return read_us;
  if (series_.metered && are_alike(shot.seen, series_.metered->seen)) return series_.metered->exposure_us;
  const Result<capture::Metering> metering = capture::meter(input, shoot);
  if (!metering) return std::nullopt;
  series_.metered = {shot.seen, metering->exposure_us};
  return metering->exposure_us;
}

}  // namespace weft::app
