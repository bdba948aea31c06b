// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "core/image/image.h"
#include "simulator/geometry/geometry_settings.h"
#include "simulator/geometry/picture_grid.h"
#include "simulator/geometry/surface_point.h"

namespace weft::simulator {

/// Heights between the samples of an image (mm, one plane, finite, not empty) by cubic convolution in both
/// directions (Keys 1981, a = -1/2): passes through every sample, is exact for quadratics, and its normal is
/// continuous. Where the picture does not repeat, the height stays that of its border beyond it.
class HeightMap {
 public:
  HeightMap(std::shared_ptr<const Image<float>> heights_mm, const PicturePlacement& placement);
  SurfacePoint at(double x_mm, double y_mm) const;
  HeightRange heights_mm(const Area& = {}) const { return range_; }
  /// Nothing for a picture that does not repeat or that is turned.
  std::optional<Period> period_mm() const;
  double steepest_slope() const { return steepest_slope_; }

 private:
  std::shared_ptr<const Image<float>> heights_mm_;
  PictureGrid grid_;
  HeightRange range_;
  double steepest_slope_;
};

}  // namespace weft::simulator
