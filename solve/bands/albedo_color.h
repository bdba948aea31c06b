// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/image/image.h"
#include "core/rig/calibration.h"
#include "solve/bands/bands.h"

namespace weft::solve {

/// Turns solved, demosaiced albedo of a session from the camera's channels into linear Rec.709 by its
/// calibration's ColorTransform. Albedo below 0 stays. Sigma goes through the transform's slope: by
/// noise as of channels that are independent in the camera, by the model and the lights as of channels that
/// err together.
class AlbedoColor {
 public:
  AlbedoColor(ColorTransform transform, int width, int threads);

  /// Whether the transform's own uncertainty is known: then calibration shares have R, G and B.
  bool has_covariance() const { return !transform_.covariance.empty(); }

  /// The band in Rec.709; valid until the next call, as is `calibration`: shares of sigma R, G, B and what
  /// follows them, of the camera's albedo, replaced by those of Rec.709 with the share of the transform.
  /// Empty where the lights have none: then R, G, B of the transform alone, if its covariance is known.
  MapBand of(const MapBand& camera, std::vector<View<const float>>& calibration);

 private:
  ColorTransform transform_;
  int threads_;
  Image<float> albedo_, sigma_, model_, calibration_;
};

}  // namespace weft::solve
