// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "calibration/response/block_light.h"
#include "calibration/response/photon_transfer.h"

namespace weft::calibration {

/// Light of a frame by channel, linear, mean over the squares that are good in all channels; nothing where
/// there is none.
std::optional<std::array<double, 3>> light_by_channel(const BlockLight& light, const TransferCurve& curve);

/// Light of one exposure over that of another of the same scene and LED, over the squares and channels that
/// both hold, each weighted by the inverse of its photon noise; nothing where there is none.
std::optional<double> light_ratio(const BlockLight& light, const BlockLight& to, const TransferCurve& curve);

/// A frame of one LED, and how long it was exposed.
struct TimedLight {
  const BlockLight* light = nullptr;
  double exposure_us = 0;
};

/// v without light, with its standard deviation.
struct DarkLevel {
  double v = 0, sigma = 0;
};

/// The v at which light against exposure time meets time 0, over the exposures of several LEDs (a list each):
/// for bodies that clip black, where nothing adds up LEDs. Each exposure weighs by a departure of
/// `time_error` of its light, as shutters have, or the scatter found where that is more. Nothing below three
/// exposures of some LED.
std::optional<DarkLevel> level_at_no_exposure(std::span<const std::vector<TimedLight>> leds,
                                              double time_error = 0.002);

}  // namespace weft::calibration
