// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/raw_frame.h"

// Gain and read noise from how the variance of a reading grows with its mean (Janesick, "Photon Transfer",
// SPIE 2007; EMVA standard 1288, release 3.1, section 6.6). Half the variance of the difference of two frames
// alike has neither scene nor fixed pattern in it.

namespace weft::calibration {

/// One channel in one square of a pair of frames of the same light and exposure.
struct TransferPoint {
  int channel = 0;              ///< 0 red, 1 green, 2 blue
  double v = 0;                 ///< mean (count - black) / (white - black)
  double variance_counts2 = 0;  ///< of one count, without bias
  double degrees_of_freedom = 0;
};

/// The points of a pair. Squares in which a photosite is full or stands at 0 are left out, for clipping takes
/// variance away; so are photosites that `bad` marks (not 0; may be empty).
std::vector<TransferPoint> transfer_points(const RawFrame& first, const RawFrame& second,
                                           View<const std::uint8_t> bad);

/// A linear curve of the response, as core's Response has it, beneath a black level that is `offset` away
/// from the file's.
struct TransferCurve {
  std::array<std::array<double, 2>, 3> linearity = {};
  double offset = 0;  ///< of v
};

/// Points of like signal together, for people.
struct TransferBin {
  double signal_counts = 0, variance_counts2 = 0, sigma_counts2 = 0;
  double fitted_counts2 = 0;
};

struct PhotonTransfer {
  double electrons_per_count = 0, sigma_electrons_per_count = 0;
  double read_noise_counts = 0, sigma_read_noise_counts = 0;  ///< rounding to whole counts included
  double chi_square_per_freedom = 0;  ///< about 1 where variance follows a straight line
  std::vector<TransferBin> bins;      ///< by rising signal
};

/// Weighted line  variance = read^2 + signal / gain  through points that were made linear: signal by the
/// curve, variance by the square of its slope. The weight of a point is that of a sample variance, 2 V^2 over
/// its degrees of freedom, with V from the line of the round before: weights from measured variances would
/// favour what came out low. `counts_at_full` is white - black. kBadData where the points do not span a
/// factor of 4 in signal, or variance does not grow with it.
Result<PhotonTransfer> fit_photon_transfer(std::span<const TransferPoint> points, const TransferCurve& curve,
                                           double counts_at_full);

}  // namespace weft::calibration
