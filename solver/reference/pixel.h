// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/radiometry.h"
#include "core/solve_record.h"
#include "core/vec.h"

namespace weft::solver {

/// One pixel under one light: `direction` l and, for each plane, strength e and reading r (+infinity
/// saturated, NaN missing).
struct PixelRow {
  Vec3 direction;
  std::array<double, 3> strength = {};
  std::array<double, 3> reading = {};
};

struct PixelOptions {
  int planes = 1;  ///< 1 (a photosite of a mosaic) or 3 (RGB)
  bool shadow_mask = false;
  std::optional<NoiseModel> noise;  ///< of a mosaic; without one the scatter of the residuals stands for it
};

/// What TileOutput holds for one pixel.
struct PixelSolution {
  Vec3 normal = {0, 0, 1};
  std::array<double, 3> albedo = {};
  double sigma_normal_deg = 180;
  std::array<double, 3> sigma_albedo = {};
  double residual = 0;
  std::uint16_t status = 0;
};

/// The slow obvious truth of the kernels, in double: least squares on rows divided by their strength (row
/// equilibration), shadow mask, covariance and status. It also solves the pixels that a kernel hands back
/// because float32 would not do: condition number over 30, fewer than three readings, nothing but noise.
PixelSolution solve_pixel(std::span<const PixelRow> rows, const PixelOptions& options);

/// A masked system keeps the mask only while its determinant stays above this.
inline constexpr double kLeastMaskedDeterminant = 0.02;
/// Readings below this share of the bright ones are taken to be in shadow.
inline constexpr double kShadowShare = 0.15;
/// However dark they are, this many readings are kept.
inline constexpr int kLeastKept = 4;
/// "Bright" is the reading of this rank from the top: the third of ten (the 70 % quantile).
inline int bright_rank(std::size_t lights) {
  return 1 + static_cast<int>(0.3 * static_cast<double>(lights - 1) + 1e-9);
}

/// A reading is called specular above kSpecularTimes the prediction, plus 3 sigma, plus this share of the
/// albedo.
inline constexpr double kSpecularTimes = 3;
inline constexpr double kSpecularMargin = 0.01;

}  // namespace weft::solver
