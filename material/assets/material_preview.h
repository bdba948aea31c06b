// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "material/filtering/roughness_mips.h"
#include "material/surface.h"
#include "report/drawing.h"

namespace weft::material {

/// A material at one place, in the terms of its parameters.
struct ShadedPoint {
  Rgb albedo = {0.5, 0.5, 0.5};
  double alpha = 0.49, alpha_along = 0.49;  ///< of GGX across and along the yarn
  double yarn_deg = 0;                      ///< azimuth of the yarn
  double f0 = 0.04;
  Rgb f0_tint = {1, 1, 1};
  double metallic = 0;
  Rgb sheen = {0.04, 0.04, 0.04};  ///< f0 of fibres that stand up
  double sheen_alpha = 0.49;       ///< their spread
  double cloth = 0;                ///< weight of their lobe
};

/// pi f (n . l) of one light: GGX over a Lambert part less what it mirrors, and the lobe of seed 000 eq. 22
/// and 23 over the same, both evaluated and blended by the weight `cloth` (seed 000, "Compositing"), which is
/// exact where a blend of their parameters would not be. Directions are those of the frame in which `normal`
/// is told and x is the azimuth 0.
Rgb shaded(const ShadedPoint& point, Vec3 normal, Vec3 to_light, Vec3 to_view);

/// The side of a ball's picture, in pixels, and what its radius stands for where a material has a size.
inline constexpr int kPreviewBall = 256;
inline constexpr double kPreviewRadius_mm = 12;

/// What a picture of a material is made of. `point` has what no map says.
struct PreviewMaps {
  const Surface& surface;
  const std::vector<MipLevel>& levels;
  std::optional<std::array<double, 2>> size_mm;
  ShadedPoint point;
};

/// A ball of the material under a lamp from the upper left, one behind it and a sky of twelve lights,
/// orthographic; maps repeat on it at their true size, by the level of mips that has the picture's pixels.
report::Picture preview_of(const PreviewMaps& maps, int threads);

}  // namespace weft::material
