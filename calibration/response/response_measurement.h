// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "calibration/response/photon_transfer.h"
#include "calibration/response/response_frames.h"
#include "calibration/response/superposition.h"
#include "core/base/result.h"
#include "core/rig/calibration.h"

namespace weft::calibration {

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
