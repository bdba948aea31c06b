// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"

namespace weft {

/// The maps that a solve left in a folder (docs/formats.md), each read when it is asked for. Rectified maps
/// are such a folder too. All are of one size and hold the channels that a solve writes: what does not is
/// refused with kBadData, what is not there with kNoInput.
class SolveMaps {
 public:
  /// Looks at the headers of status, normal, albedo and sigma, and at no pixel.
  static Result<SolveMaps> open(const std::filesystem::path& folder);

  Size size() const { return size_; }
  Result<Image<std::uint16_t>> status() const;  ///< bits of StatusBit (core/solve/solve_record.h)
  Result<LoadedImage> normal() const;           ///< X, Y, Z: unit, rig frame
  Result<LoadedImage> albedo() const;           ///< R, G, B
  /// R, G, B of the albedo and normal_deg; their parts R.noise ..., R.model ... and, where the calibration
  /// has a covariance, R.calibration ... Maps of early versions have no parts by noise and by the model:
  /// theirs is noise alone.
  Result<LoadedImage> sigma() const;

 private:
  SolveMaps(std::filesystem::path folder, Size size) : folder_(std::move(folder)), size_(size) {}

  std::filesystem::path folder_;
  Size size_;
};

}  // namespace weft
