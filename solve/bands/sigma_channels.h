// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "solve/bands/bands.h"

namespace weft::solve {

/// The channels of sigma.exr (docs/formats.md): for R, G, B of the albedo and normal_deg the root of the sum
/// of the squares of their parts, then the parts: by noise, by the model, and by the calibration where it
/// says how sure it is.
inline constexpr std::size_t kSumOfAngle = 3;  ///< the channel normal_deg

class SigmaChannels {
 public:
  /// `calibration` names those of R, G, B and normal_deg that the calibration has a share in, in this order.
  SigmaChannels(int width, const std::vector<std::string>& calibration);

  /// "R", "G", "B", "normal_deg", "R.noise" ... "normal_deg.noise", the same with .model, and
  /// `calibration`'s with .calibration.
  const std::vector<std::string>& names() const { return names_; }

  /// A view a name over band.albedo_rows; valid until the next call. The band has its model's part, and
  /// `calibration` a view for each of the names given. Angles are 180 degrees at most.
  std::vector<View<const float>> of(const MapBand& band, std::span<const View<const float>> calibration);

 private:
  int width_;
  std::vector<std::string> names_;
  Image<float> sums_;  ///< R, G, B, normal_deg
};

}  // namespace weft::solve
