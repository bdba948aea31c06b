// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "material/assets/shade.h"
#include "material/filtering/roughness_mips.h"
#include "material/surface.h"
#include "report/drawing.h"

namespace weft::app {

/// The side of a ball's picture, in pixels, and what its radius stands for where a material has a size.
inline constexpr int kPreviewBall = 256;
inline constexpr double kPreviewRadius_mm = 12;

/// What a picture of a material is made of. `point` has what no map says.
struct PreviewMaps {
  const material::Surface& surface;
  const std::vector<material::MipLevel>& levels;
  std::optional<std::array<double, 2>> size_mm;
  ShadedPoint point;
};

/// A ball of the material under a lamp from the upper left, one behind it and a sky of twelve lights,
/// orthographic; maps repeat on it at their true size, by the level of mips that has the picture's pixels.
report::Picture preview_of(const PreviewMaps& maps, int threads);

}  // namespace weft::app
