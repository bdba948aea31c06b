// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "calibration/lights/paper_model.h"
#include "calibration/lights/physical.h"

namespace weft::calibration {

// What sheets that contradict each other may be: stories that are tried on their readings.

/// LEDs that light the sheets as if each stood where the tape has another one: `as[k]` of those of which
/// `as[k]` is not k.
struct ExchangedLeds {
  std::vector<std::size_t> as;
  double rms_before = 0, rms_after = 0;  ///< of ln(reading / model) over the LEDs that are exchanged
};
/// By readings and tape alone, each LED's flux free; nothing where every LED fits its own place best, or
/// another one's not far better.
std::optional<ExchangedLeds> find_exchanged(const PaperScene& start, std::span<const PaperReading> readings);

/// A light that is the same under every LED, as a share of their mean: of the room, where the dark shots lack
/// it. Below 0 it is in the dark shots alone.
struct RoomLight {
  double share = 0, sigma = 0;
  double chi_square = 0;  ///< of a fit without that light
  bool agrees = false;    ///< that fit has no misfit
};
/// By up to twenty quick fits and four whole ones; nothing where no share explains half of the misfit, or it
/// is within five sigmas.
std::optional<RoomLight> find_room_light(const PaperScene& start, std::span<const PaperReading> readings,
                                         const LightFitOptions& options, const LightFit& without);

}  // namespace weft::calibration
