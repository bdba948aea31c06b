// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "calibration/response/block_light.h"
#include "calibration/response/photon_transfer.h"
#include "calibration/response/response_frames.h"
#include "calibration/response/superposition.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"

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

/// How the black level was found.
enum class BlackFrom { kDarkFrames, kSuperposition, kExposures, kFile };

/// One LED as the camera sees it in this scene.
struct LedBalance {
  int led = 0;
  std::array<double, 3> light = {};  ///< reading, by channel, mean over the frame
};

/// An exposure of which a ratio to the longest was measured.
struct MeasuredRatio {
  ExposureRatio ratio;
  double scatter = 0;  ///< standard deviation among LEDs, relative; 0 for one
};

/// What the frames of a response capture say.
struct ResponseMeasurement {
  Response response;
  PhotonTransfer transfer;
  std::optional<Superposition> superposition;
  BlackFrom black_from = BlackFrom::kFile;
  double black_counts = 0, sigma_black_counts = 0;
  double dark_counts_per_s = 0;  ///< by warmth and stray light, from dark frames of several exposures
  double clipped_share = 0;      ///< of dark photosites at count 0
  double drift = 0;              ///< of light from frame to frame, relative
  std::vector<LedBalance> balance;
  std::vector<MeasuredRatio> ratios;
};

/// Black level, noise, linearity, exposure ratios and white balance, in this order. Errors (kBadData): fewer
/// than three exposures or lights with pairs of frames; a LED that did not light; light that does not add up
/// by over 5 percent; what fit_photon_transfer() refuses.
Result<ResponseMeasurement> measure_response(const ResponseFrames& frames);

/// "dark frames" and so on.
const char* name_of(BlackFrom from);

}  // namespace weft::calibration
